// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy.hpp"

namespace stylet::meshing {

/// Quality of the mesh and how well it reproduces its input; `seconds` is left to the caller.
MeshReport report_on(const TetMesh& mesh, const Anatomy& anatomy);

}  // namespace stylet::meshing
