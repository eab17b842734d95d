// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy.hpp"

namespace stylet::meshing {

/// Report on the quality of the mesh and how well it reproduces its input. The caller sets `seconds`.
MeshReport report_on(const TetMesh& mesh, const Anatomy& anatomy);

}  // namespace stylet::meshing
