// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet::results {

/// The largest number not above `value` that is 1, 2 or 5 times a power of ten. @param value > 0
double round_below(double value);

/// The least number not below `value` that is 1, 2, 2.5 or 5 times a power of ten. @param value > 0
double round_above(double value);

}  // namespace stylet::results
