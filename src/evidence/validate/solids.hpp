// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

#include <functional>

/// Supports, loads and fields for checks of the tissue without a needle.
namespace stylet::validate {

/// Nodes of a mesh for which `chosen` holds.
std::vector<Index> nodes_where(const TetMesh& mesh, const std::function<bool(const Vec3&)>& chosen);

/// Nodal values of a displacement field [mm] (3 × displacement nodes).
VecX sample(const Tissue& tissue, const std::function<Vec3(const Vec3&)>& field);

/// Stress of a homogeneous displacement gradient [MPa].
Mat3 stress_of(const Material& material, const Mat3& gradient);

/// Nodal forces [N] (3 × displacement nodes) of the traction σ n on the outer faces, which is constant on each face. A
/// third acts on each corner of a linear face, or on the middle of each edge of a quadratic face.
/// @param stress_at returns σ [MPa] for the centre of a face [mm] and its region
VecX traction(const Tissue& tissue, const std::function<Mat3(const Vec3&, int region)>& stress_at);

/// Largest deviation of an entry, divided by the largest expected value.
double relative_error(const VecX& value, const VecX& expected);

/// A cube of 60 mm on a fixed floor, loaded from above by a smooth pressure distribution with a peak of 2 kPa. The mesh
/// is irregular.
struct PressedBlock {
  double dent_mm = 0.0;  ///< mean displacement under the load, weighted with the load
  Index displacement_nodes = 0;
};
/// @param cells number of cells along an edge of the cube, of six tetrahedra each
/// Returns the errors of Tissue::build.
Result<PressedBlock> press_block(const Material& material, int cells, Element element);

}  // namespace stylet::validate
