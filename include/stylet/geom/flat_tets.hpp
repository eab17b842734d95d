// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

namespace stylet {

/// The six dihedral angles, between the faces of tetrahedron t [°].
std::array<double, 6> dihedral_angles_deg(const TetMesh& mesh, Index t);

/// A tetrahedron counts as nearly flat when one of its dihedral angles is smaller than this.
inline constexpr double kNearlyFlat_deg = 5.0;

/// Tetrahedra with a dihedral angle below kNearlyFlat_deg. check_mesh() accepts them: it refuses only tetrahedra
/// without volume.
struct NearlyFlatTets {
  Index count = 0;
  Index worst = -1;        ///< number of the tetrahedron with the smallest angle, -1 where the mesh has none
  double angle_deg = 0.0;  ///< its smallest angle
};

NearlyFlatTets nearly_flat_tets(const TetMesh& mesh);

/// Warning about nearly flat tetrahedra: their number, the flattest one with its angle and place, and the cure. Empty
/// where the mesh has none.
std::string nearly_flat_warning(const TetMesh& mesh);

}  // namespace stylet
