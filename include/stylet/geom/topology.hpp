// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

namespace stylet {

/// A triangle of a tetrahedral mesh; its corners are ordered so that the normal points out of `tet`.
struct Face {
  std::array<Index, 3> nodes;
  Index tet;        ///< the tetrahedron it belongs to
  int local;        ///< the face lies opposite this local vertex of `tet`
  Index neighbour;  ///< the tetrahedron on the other side, -1 on the outer surface
};

/// Neighbourhood relations between the elements of a mesh, built once per mesh.
struct Topology {
  explicit Topology(const TetMesh& mesh);

  std::vector<std::array<Index, 4>> neighbour;  ///< (m) tetrahedron behind the face opposite local vertex i, or -1
  std::vector<Face> boundary;                   ///< outer faces of the mesh
  std::vector<Face> interfaces;  ///< faces between two regions, each once, with the lower region's element as `tet`
  std::vector<std::vector<Index>> node_tets;  ///< (n) tetrahedra around each node
};

/// Local numbers of the vertices of the face opposite local vertex i, ordered so that the normal points out of a
/// tetrahedron of positive volume.
inline constexpr std::array<std::array<int, 3>, 4> kFaceVertices{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

}  // namespace stylet
