// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

namespace stylet {

/// Smallest and largest value of a quantity.
struct Range {
  double min = 0.0;
  double max = 0.0;
};

/// Size of a mesh and quality of its elements.
struct MeshQuality {
  Index nodes = 0;
  Index tets = 0;
  Range dihedral_deg;                    ///< smallest and largest dihedral angle of all elements
  Range edge_mm;                         ///< shortest and longest edge of all elements
  double radius_ratio_min = 0;           ///< smallest 3 r_in / r_circ of all elements; the regular tetrahedron has 1
  double fraction_below_12_deg = 0;      ///< fraction of the elements whose smallest dihedral angle is below 12°
  std::vector<double> region_volume_cc;  ///< (regions) volume [cm³]
  std::vector<Index> region_tets;        ///< (regions) number of tetrahedra
  std::array<Index, 18> dihedral_histogram{};  ///< number of dihedral angles in each bin of 10°
};

MeshQuality mesh_quality(const TetMesh& mesh);

}  // namespace stylet
