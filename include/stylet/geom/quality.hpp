// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

namespace stylet {

struct Range {
  double min = 0.0;
  double max = 0.0;
};

/// What a mesh is made of and how good its elements are.
struct MeshQuality {
  Index nodes = 0;
  Index tets = 0;
  Range dihedral_deg;  ///< over all six angles of all elements
  Range edge_mm;
  double radius_ratio_min = 0;                 ///< 3 r_in / r_circ, 1 for the regular tetrahedron, over all elements
  double fraction_below_12_deg = 0;            ///< elements whose smallest dihedral angle is under 12°
  std::vector<double> region_volume_cc;        ///< (regions)
  std::vector<Index> region_tets;              ///< (regions)
  std::array<Index, 18> dihedral_histogram{};  ///< counts in bins of 10°
};

MeshQuality mesh_quality(const TetMesh& mesh);

}  // namespace stylet
