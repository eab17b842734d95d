// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/topology.hpp"

namespace stylet::detail {

/// One side of a face: the face's node numbers in ascending order and the tetrahedron that has it.
struct FaceSide {
  std::array<Index, 3> key;
  Index tet;
  int local;  ///< the face lies opposite this local vertex
};

/// All sides of all faces, the sides of one face next to each other, in an order that depends on the mesh only.
/// Linear in the number of tetrahedra: sides are counted into buckets by their lowest node, then each small bucket is
/// sorted. Needs node numbers in range.
std::vector<FaceSide> sorted_face_sides(const TetMesh& mesh);

}  // namespace stylet::detail
