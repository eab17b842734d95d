// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/topology.hpp"

namespace stylet::detail {

/// One side of a face: the face's node numbers in ascending order, and the tetrahedron on this side.
struct FaceSide {
  std::array<Index, 3> key;
  Index tet;
  int local;  ///< the face lies opposite this local vertex
};

/// All sides of all faces, with both sides of a face next to each other, in an order that depends only on the mesh.
/// Takes linear time: sides are counted into buckets by their lowest node, and each small bucket is sorted. All node
/// numbers must be in range.
std::vector<FaceSide> sorted_face_sides(const TetMesh& mesh);

}  // namespace stylet::detail
