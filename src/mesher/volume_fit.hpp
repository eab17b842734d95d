// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy.hpp"
#include "editable_mesh.hpp"

namespace stylet::meshing {

/// Makes up for the volume that flat faces cut off round surfaces: shifts each structure's surface (its offset) by what
/// its region lacks per area, and moves the nodes there. Few nodes move by more than a few per cent of an edge.
void fit_volumes(EditableMesh& mesh, Anatomy& anatomy);

}  // namespace stylet::meshing
