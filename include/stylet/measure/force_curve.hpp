// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <span>
#include <vector>

namespace stylet::measure {

/// Axial force of the hand over time, at equal steps.
struct ForceCurve {
  double dt_s = 0.0;
  std::vector<double> force_N;  ///< at dt, 2 dt, …

  [[nodiscard]] double peak_N() const;  ///< largest absolute value; 0 without steps
};

/// Of a run whose steps are all `dt_s` long.
ForceCurve force_curve(std::span<const Step> steps, double dt_s);

/// Root mean square of the difference of two curves [N], at the times both have, as long as both last. The longer of
/// the two steps must be a multiple of the other. NaN when they have no time in common.
double rms_difference_N(const ForceCurve& one, const ForceCurve& other);

}  // namespace stylet::measure
