// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/scenario.hpp"

namespace stylet {

/// Depth [mm] by which a force [N] on a needle's tip moves tissue of these parameters around it, deep inside: so far
/// behind the place where it is pushed to does a tip cut. Less where the tissue stiffens (docs/theory/stiffening.md).
double cutting_lag_mm(const TissueParameters& tissue, double force_N, double needle_diameter_mm);

}  // namespace stylet
