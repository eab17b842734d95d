// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"

#include <functional>

/// What checks of the tissue by itself have in common: supports, loads, fields.
namespace stylet::validate {

/// Nodes of a mesh for which `chosen` holds.
std::vector<Index> nodes_where(const TetMesh& mesh, const std::function<bool(const Vec3&)>& chosen);

/// Nodal values of a displacement field [mm] (3 × displacement nodes).
VecX sample(const Tissue& tissue, const std::function<Vec3(const Vec3&)>& field);

/// Stress of a homogeneous displacement gradient [MPa].
Mat3 stress_of(const Material& material, const Mat3& gradient);

/// Nodal forces [N] (3 × displacement nodes) of the traction σ n on the outer faces, constant on a face: a third on
/// each corner of a linear face, on each edge's middle of a quadratic one.
/// @param stress_at σ [MPa] at the middle of a face [mm] of a region
VecX traction(const Tissue& tissue, const std::function<Mat3(const Vec3&, int region)>& stress_at);

/// Largest deviation over the largest value.
double relative_error(const VecX& value, const VecX& expected);

/// A cube of 60 mm stands on its floor and is pressed from above by a smooth hill of pressure of 2 kPa. Irregular mesh.
struct PressedBlock {
  double dent_mm = 0.0;  ///< mean depth under the load, weighted with it
  Index displacement_nodes = 0;
};
/// @param cells along an edge of the cube, of six tetrahedra each
/// Errors: those of Tissue::build.
Result<PressedBlock> press_block(const Material& material, int cells, Element element);

}  // namespace stylet::validate
