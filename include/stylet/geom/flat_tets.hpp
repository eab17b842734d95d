// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

namespace stylet {

/// The six angles between the faces of tetrahedron t [°].
std::array<double, 6> dihedral_angles_deg(const TetMesh& mesh, Index t);

/// A tetrahedron with a smaller angle between two of its faces is nearly flat.
inline constexpr double kNearlyFlat_deg = 5.0;

/// Tetrahedra with a dihedral angle below kNearlyFlat_deg. check_mesh() refuses those without volume only.
struct NearlyFlatTets {
  Index count = 0;
  Index worst = -1;        ///< number of the one with the smallest angle
  double angle_deg = 0.0;  ///< its smallest angle
};

NearlyFlatTets nearly_flat_tets(const TetMesh& mesh);

/// A warning about nearly flat tetrahedra: their number, the flattest one with its angle and place, and the cure.
/// Empty where the mesh has none.
std::string nearly_flat_warning(const TetMesh& mesh);

}  // namespace stylet
