// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy.hpp"

namespace stylet::meshing {

/// Makes a body of the input fit to be meshed: crops what lies far from all other structures and rounds its edges (the
/// first and last slice cut it off flat; refinement would not end along such edges). Pieces that hold no other
/// structure, such as an arm beside the trunk, are left out. Notes what was done.
/// @return volume left, as a fraction of the volume before, not counting the rounding
double trim_body(GridShape& body, Anatomy& anatomy);

}  // namespace stylet::meshing
