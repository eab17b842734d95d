// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"
#include "stylet/geom/tet_mesh.hpp"

namespace stylet {

/// A mesh with every edge halved: the same bodies and surfaces, eight tetrahedra in the place of each.
struct Subdivision {
  TetMesh mesh;                            ///< the old nodes first; tetrahedra 8 t … 8 t + 7 make up the old t
  std::vector<std::array<Index, 2>> ends;  ///< of the edge in whose middle each new node lies, old numbers
};

/// Regular refinement: four tetrahedra at the corners, the octahedron between them cut along one diagonal.
/// @cite Bey1995
Subdivision subdivide(const TetMesh& mesh);

/// The same material point in the subdivided mesh.
MaterialPoint in_subdivision(const MaterialPoint& at);

}  // namespace stylet
