// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/scenario.hpp"

namespace stylet {

/// Cutting lag: displacement [mm] of tissue with these parameters, deep inside the body, under a force [N] on the
/// needle's tip. The tip cuts this far behind the place to which the base has pushed it. Stiffening tissue
/// (docs/theory/stiffening.md) has a smaller lag.
double cutting_lag_mm(const TissueParameters& tissue, double force_N, double needle_diameter_mm);

}  // namespace stylet
