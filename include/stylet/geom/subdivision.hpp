// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"
#include "stylet/geom/tet_mesh.hpp"

namespace stylet {

/// A mesh in which every edge has been halved and each tetrahedron replaced by eight. Bodies and surfaces are
/// unchanged.
struct Subdivision {
  TetMesh mesh;  ///< the original nodes come first; tetrahedra 8 t … 8 t + 7 replace the original tetrahedron t
  /// (new nodes) both ends of the edge whose middle is the new node, original numbers.
  std::vector<std::array<Index, 2>> ends;
};

/// Regular refinement: each tetrahedron becomes four at its corners, and the octahedron between these is cut along one
/// diagonal into four more.
/// @cite Bey1995
Subdivision subdivide(const TetMesh& mesh);

/// The same material point, expressed in the subdivided mesh.
MaterialPoint in_subdivision(const MaterialPoint& at);

}  // namespace stylet
