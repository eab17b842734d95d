// SPDX-License-Identifier: GPL-3.0-or-later
#include "outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::phantom {

using Eigen::Vector2d;
using std::numbers::pi;

Irregularity::Irregularity(Random& random, double amplitude) {
  for (std::size_t i = 0; i < amplitude_.size(); ++i) {
    amplitude_[i] = amplitude / static_cast<double>(first_order_ + i) * (0.5 + random.uniform());
    phase_[i] = 2.0 * pi * random.uniform();
    turn_[i] = 2.0 * (random.uniform() - 0.5);
  }
}

double Irregularity::factor(double theta, double t) const {
  double sum = 1.0;
  for (std::size_t i = 0; i < amplitude_.size(); ++i) {
    sum += amplitude_[i] * std::cos(static_cast<double>(first_order_ + i) * theta + phase_[i] + turn_[i] * t);
  }
  return sum;
}

Vector2d superellipse(double a, double b, double n, double theta) {
  const auto power = [n](double c) { return std::copysign(std::pow(std::abs(c), 2.0 / n), c); };
  return {a * power(std::cos(theta)), b * power(std::sin(theta))};
}

Outline trace(int count, const std::function<Vector2d(double)>& curve) {
  const int dense = 8 * count;
  std::vector<Vector2d> points(static_cast<std::size_t>(dense) + 1);
  std::vector<double> length(points.size(), 0.0);
  for (int i = 0; i <= dense; ++i) {
    points[i] = i == dense ? points[0] : curve(2.0 * pi * i / dense);
    if (i > 0) length[i] = length[i - 1] + (points[i] - points[i - 1]).norm();
  }
  Outline outline;
  outline.reserve(static_cast<std::size_t>(count));
  for (int k = 0, i = 1; k < count; ++k) {
    const double wanted = length[dense] * k / count;
    while (length[i] < wanted) ++i;
    const double step = length[i] - length[i - 1];
    const double part = step > 0.0 ? (wanted - length[i - 1]) / step : 0.0;
    outline.push_back(points[i - 1] + part * (points[i] - points[i - 1]));
  }
  return outline;
}

Contour at_height(const Outline& outline, double z) {
  const auto rounded = [](double v) { return std::round(v * 1000.0) / 1000.0; };
  Contour contour;
  contour.points.reserve(outline.size());
  for (const Vector2d& p : outline) contour.points.emplace_back(rounded(p.x()), rounded(p.y()), rounded(z));
  return contour;
}

double area(const Outline& outline) {
  double twice = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d& a = outline[i];
    const Vector2d& b = outline[(i + 1) % outline.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

double interpolate(std::span<const double> knots, std::span<const double> values, double x) {
  const std::size_t n = knots.size();
  if (x <= knots.front()) return values.front();
  if (x >= knots.back()) return values.back();
  const std::size_t hi = static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), x) - knots.begin());
  const std::size_t lo = hi - 1;
  const auto slope = [&](std::size_t i) {
    const std::size_t left = i == 0 ? 0 : i - 1;
    const std::size_t right = std::min(i + 1, n - 1);
    return (values[right] - values[left]) / (knots[right] - knots[left]);
  };
  const double h = knots[hi] - knots[lo];
  const double u = (x - knots[lo]) / h;
  return values[lo] * (1 + 2 * u) * (1 - u) * (1 - u) + values[hi] * u * u * (3 - 2 * u) +
         h * slope(lo) * u * (1 - u) * (1 - u) - h * slope(hi) * u * u * (1 - u);
}

}  // namespace stylet::phantom
