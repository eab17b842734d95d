// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy.hpp"

namespace stylet::meshing {

/// Prepares a body of the input for meshing. It crops parts far away from all other structures, leaves out pieces that
/// contain no other structure, such as an arm beside the trunk, and rounds the edges where the first and last slice cut
/// the body off; along such edges refinement would not end. Adds notes about what was done.
/// @return volume left / volume before, apart from the rounding
double trim_body(GridShape& body, Anatomy& anatomy);

}  // namespace stylet::meshing
