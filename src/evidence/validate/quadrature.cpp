// SPDX-License-Identifier: GPL-3.0-or-later
#include "quadrature.hpp"

#include <cmath>
#include <numbers>

namespace stylet::validate {

std::vector<GaussPoint> gauss_legendre(int n) {
  std::vector<GaussPoint> rule;
  for (int k = 0; k < n; ++k) {
    // Roots of the Legendre polynomial on −1 … 1 by Newton's method, starting from roots of a Chebyshev polynomial.
    double x = -std::cos(std::numbers::pi * (k + 0.75) / (n + 0.5));
    double slope = 0.0;
    constexpr int enough = 20;
    for (int i = 0; i < enough; ++i) {
      double before = 1.0;
      double value = x;
      for (int degree = 2; degree <= n; ++degree) {
        const double next = ((2 * degree - 1) * x * value - (degree - 1) * before) / degree;
        before = value;
        value = next;
      }
      slope = n * (x * value - before) / (x * x - 1.0);
      x -= value / slope;
    }
    rule.push_back({0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)});
  }
  return rule;
}

std::vector<TetrahedronPoint> tetrahedron_rule(int n) {
  const auto line = gauss_legendre(n);
  std::vector<TetrahedronPoint> points;
  for (const GaussPoint& i : line) {
    for (const GaussPoint& j : line) {
      for (const GaussPoint& k : line) {
        const double a = i.x;
        const double b = (1.0 - a) * j.x;
        const double c = (1.0 - a) * (1.0 - j.x) * k.x;
        const double cone = 6.0 * (1.0 - a) * (1.0 - a) * (1.0 - j.x);
        points.push_back({Vec4(1.0 - a - b - c, a, b, c), cone * i.weight * j.weight * k.weight});
      }
    }
  }
  return points;
}

}  // namespace stylet::validate
