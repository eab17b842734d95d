// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"

namespace stylet::detail {

/// Refuses supports that leave part of the mesh free to move as a rigid body. Every part (tetrahedra connected by
/// common nodes) needs three fixed nodes that are not on a line.
/// @param is_fixed (n) 1 for fixed nodes
Result<> check_supports(const TetMesh& mesh, const std::vector<char>& is_fixed);

/// The error for a mesh whose stiffness is singular at node `loose` although check_supports() accepted it: some part is
/// connected only by a node or an edge.
Error loose_part(const TetMesh& mesh, Index loose);

}  // namespace stylet::detail
