// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tetrahedraliser.hpp"

namespace stylet::meshing {

/// Keeps the pieces of the mesh that hold more than body: tetrahedra that hang together by faces. What is left over (an
/// arm beside the trunk, a splinter that touches the rest in one edge) is dropped.
/// @param body label of the body, 0 = none
/// @return volume dropped [mm³]
double drop_loose_pieces(RawMesh& mesh, int body);

}  // namespace stylet::meshing
