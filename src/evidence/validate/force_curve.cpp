// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/validate/force_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet::validate {

double ForceCurve::peak_N() const {
  double peak = 0.0;
  for (const double force : force_N) peak = std::max(peak, std::abs(force));
  return peak;
}

ForceCurve force_curve(std::span<const Step> steps, double dt_s) {
  ForceCurve curve{.dt_s = dt_s, .force_N = {}};
  curve.force_N.reserve(steps.size());
  for (const Step& step : steps) curve.force_N.push_back(step.force_axial_N);
  return curve;
}

double rms_difference_N(const ForceCurve& one, const ForceCurve& other) {
  const double dt = std::max(one.dt_s, other.dt_s);
  const auto every_one = static_cast<std::size_t>(std::lround(dt / one.dt_s));
  const auto every_other = static_cast<std::size_t>(std::lround(dt / other.dt_s));
  const std::size_t count = std::min(one.force_N.size() / every_one, other.force_N.size() / every_other);
  if (count == 0) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (std::size_t k = 1; k <= count; ++k)
    sum += std::pow(one.force_N[k * every_one - 1] - other.force_N[k * every_other - 1], 2);
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace stylet::validate
