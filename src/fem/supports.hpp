// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"

namespace stylet::detail {

/// Refuses supports that leave a part of the mesh free to move as a rigid body: every part (tetrahedra connected by
/// nodes) needs three fixed nodes that are not on a line.
/// @param is_fixed (n) 1 for fixed nodes
Result<> check_supports(const TetMesh& mesh, const std::vector<char>& is_fixed);

/// The refusal for a mesh whose stiffness turned out singular at node `loose` all the same: a part that hangs on by a
/// node or an edge only.
Error loose_part(const TetMesh& mesh, Index loose);

}  // namespace stylet::detail
