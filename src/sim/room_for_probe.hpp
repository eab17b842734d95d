// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/scenario.hpp"

namespace stylet {

/// Makes tissue as soft as what is around a probe in the rectum: 0.5 kPa, compressible, without a surface that a needle
/// has to break.
void make_room_for_probe(TissueParameters& inside);

}  // namespace stylet
