// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy.hpp"
#include "editable_mesh.hpp"

namespace stylet::meshing {

/// Compensates the volume that flat faces cut off from round surfaces. Each structure's surface (its offset) is shifted
/// by missing volume / area, and the nodes are moved there. Few nodes move by more than a few per cent of an edge.
void fit_volumes(EditableMesh& mesh, Anatomy& anatomy);

}  // namespace stylet::meshing
