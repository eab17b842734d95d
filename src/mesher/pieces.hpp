// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tetrahedraliser.hpp"

namespace stylet::meshing {

/// Keeps the largest piece of the mesh and other pieces that contain more than body. A piece consists of tetrahedra
/// connected by faces. Other pieces, such as an arm beside the trunk or a splinter that touches the rest in one edge,
/// are removed.
/// @param body label of the body, 0 = none
/// @return volume removed [mm³]
double drop_loose_pieces(RawMesh& mesh, int body);

}  // namespace stylet::meshing
