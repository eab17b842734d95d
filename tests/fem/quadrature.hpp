// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <cmath>

namespace stylet::test {

/// A point of a quadrature rule on a tetrahedron.
struct QuadraturePoint {
  Vec4 weights;   ///< barycentric coordinates
  double factor;  ///< share of the volume, sums to 1
};

/// Conical product of Gauss–Legendre rules with four points each: 64 points, exact to degree 5.
/// @cite Stroud1971
inline std::vector<QuadraturePoint> quadrature() {
  const double inner = std::sqrt(3.0 / 7.0 - 2.0 / 7.0 * std::sqrt(6.0 / 5.0));
  const double outer = std::sqrt(3.0 / 7.0 + 2.0 / 7.0 * std::sqrt(6.0 / 5.0));
  const double heavy = (18.0 + std::sqrt(30.0)) / 72.0;
  const double light = (18.0 - std::sqrt(30.0)) / 72.0;
  const std::array<double, 4> x{0.5 - 0.5 * outer, 0.5 - 0.5 * inner, 0.5 + 0.5 * inner, 0.5 + 0.5 * outer};
  const std::array<double, 4> w{light, heavy, heavy, light};
  std::vector<QuadraturePoint> points;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 4; ++k) {
        const double a = x[i];
        const double b = (1 - a) * x[j];
        const double c = (1 - a) * (1 - x[j]) * x[k];
        points.push_back({Vec4(1 - a - b - c, a, b, c), 6.0 * w[i] * w[j] * w[k] * (1 - a) * (1 - a) * (1 - x[j])});
      }
    }
  }
  return points;
}

}  // namespace stylet::test
