// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "random.hpp"
#include "stylet/geom/contours.hpp"

#include <Eigen/Core>

#include <array>
#include <functional>
#include <span>
#include <vector>

/// Closed outlines in a transverse slice; x points to the left, y posteriorly [mm].
namespace stylet::phantom {

using Outline = std::vector<Eigen::Vector2d>;

/// Low-order irregularity of an outline: a factor 1 + Σ a_m cos(mθ + φ_m + ψ_m t), m = 2…5. It turns slowly with the
/// height t, so that neighbouring slices resemble each other.
class Irregularity {
 public:
  /// @param amplitude total amplitude, e.g. 0.03; order m contributes about amplitude / m
  Irregularity(Random& random, double amplitude);
  [[nodiscard]] double factor(double theta, double t) const;

 private:
  static constexpr int first_order_ = 2;
  std::array<double, 4> amplitude_{};
  std::array<double, 4> phase_{};
  std::array<double, 4> turn_{};
};

/// Point of a superellipse |x/a|^n + |y/b|^n = 1 at parameter theta. n = 2 is an ellipse; larger n gives squarer
/// shapes.
Eigen::Vector2d superellipse(double a, double b, double n, double theta);

/// `count` points at equal arc lengths along the closed curve theta → point, theta in [0, 2π).
Outline trace(int count, const std::function<Eigen::Vector2d(double)>& curve);

/// The outline as a contour at height z, with coordinates rounded to 0.001 mm (far finer than any drawing).
Contour at_height(const Outline& outline, double z);

/// Area [mm²]; positive when counter-clockwise seen from +z.
double area(const Outline& outline);

/// Smooth curve through the points of a table (Catmull–Rom with uneven knots), constant outside.
/// @param knots ascending (n)
/// @param values (n)
double interpolate(std::span<const double> knots, std::span<const double> values, double x);

}  // namespace stylet::phantom
