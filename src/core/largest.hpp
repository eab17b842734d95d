// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace stylet {

/// The larger of two numbers, or NaN where either is NaN. std::max would drop a NaN in its second argument.
[[nodiscard]] inline double larger_or_nan(double a, double b) { return a >= b || std::isnan(a) ? a : b; }

}  // namespace stylet
