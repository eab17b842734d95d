// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/axis_curve.hpp"

#include <algorithm>

namespace stylet {

AxisCurve::Place AxisCurve::place(double s) const {
  const double x = std::clamp(s / spacing_, 0.0, static_cast<double>(intervals_));
  const int k = std::min(static_cast<int>(x), intervals_ - 1);
  return {k, x - k};
}

AxisCurve::Weights AxisCurve::weights(double s) const {
  if (!(s > 0.0)) return {};
  const auto [k, u] = place(s);
  const double v = 1.0 - u;
  return spread(k, v * v * (1.0 + 2.0 * u), u * v * v, u * u * (3.0 - 2.0 * u), -u * u * v);
}

AxisCurve::Weights AxisCurve::slopes(double s) const {
  if (!(s > 0.0)) return {};
  const auto [k, u] = place(s);
  const double h = 1.0 / spacing_;
  return spread(k, -6.0 * h * u * (1.0 - u), h * (1.0 - u) * (1.0 - 3.0 * u), 6.0 * h * u * (1.0 - u),
                h * u * (3.0 * u - 2.0));
}

AxisCurve::Weights AxisCurve::spread(int k, double value0, double slope0, double value1, double slope1) const {
  Weights w;
  w.first = k - 1;
  auto& [before, here, next, after] = w.value;
  here = value0;
  next = value1;
  if (k > 0) {
    before -= 0.5 * slope0;
    next += 0.5 * slope0;
  }
  if (k + 1 < intervals_) {
    here -= 0.5 * slope1;
    after += 0.5 * slope1;
  } else {  // no curvature at the tip: slope = (5 d_n - 6 d_(n-1) + d_(n-2)) / 4
    next += 1.25 * slope1;
    here -= 1.5 * slope1;
    before += 0.25 * slope1;
  }
  // The clamp itself does not move.
  if (k == 0) here = 0.0;
  if (k <= 1) before = 0.0;
  return w;
}

}  // namespace stylet
