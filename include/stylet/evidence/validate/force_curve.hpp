// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <span>
#include <vector>

namespace stylet::validate {

/// Axial force of the hand over time, with a constant time step.
struct ForceCurve {
  double dt_s = 0.0;
  std::vector<double> force_N;  ///< force at dt_s, 2 dt_s, …

  [[nodiscard]] double peak_N() const;  ///< largest absolute force; 0 without steps
};

/// The force curve of a run whose steps are all `dt_s` long.
ForceCurve force_curve(std::span<const Step> steps, double dt_s);

/// Root mean square of the difference of two curves [N] at their common times, up to the end of the shorter curve. The
/// larger time step must be a multiple of the smaller. NaN if they have no time in common.
double rms_difference_N(const ForceCurve& one, const ForceCurve& other);

}  // namespace stylet::validate
