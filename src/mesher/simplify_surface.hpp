// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/surface.hpp"

namespace stylet::meshing {

/// Leaves out points of a closed surface where it is nearly flat. The volume stays the same, and so do closedness and
/// orientation; the surface moves by some hundredths of a millimetre.
/// @param longest_mm edges longer than this stay
/// @cite LindstromTurk1998
void simplify(Surface& surface, double longest_mm);

}  // namespace stylet::meshing
