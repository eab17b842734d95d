// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::phantom {

using Eigen::Vector2d;

namespace {

/// Relative size of the section at relative height t in [-1, 1]: slender at the apex (-1), blunt at the base (+1).
double width_factor(double t) {
  const double u = std::min(std::abs(t), 1.0);
  return t < 0.0 ? std::sqrt(1.0 - std::pow(u, 2.2)) : std::pow(1.0 - std::pow(u, 3.6), 0.42);
}

/// Towards the ends, depth decreases later than width.
double depth_factor(double t) { return std::pow(width_factor(t), 0.85); }

/// The gland leans by one millimetre: posteriorly at the base and anteriorly at the apex.
double centre_y(double t) { return t; }

}  // namespace

Prostate::Prostate(const Sizes& sizes, Random& random)
    : Organ("Prostate", "ORGAN", {220, 70, 60}), hollow_(sizes.prostate_hollow), irregularity_(random, 0.035) {
  half_depth = 17.0;
  const auto resize = [&](double depth) {
    half_depth = depth;
    half_width = depth * sizes.prostate_width;
    half_length = depth * sizes.prostate_length;
  };
  resize(half_depth);
  // The hollow does not scale with the gland, so the volume is met by repetition.
  for (int i = 0; i < 4; ++i) resize(half_depth * std::cbrt(sizes.prostate_cc / volume_cc()));
  low = -0.97 * half_length;
  high = 0.97 * half_length;
}

double Prostate::front(double z) const {
  const double t = z / half_length;
  return centre_y(t) - half_depth * depth_factor(t);
}

Outline Prostate::outline(double z) const {
  const double t = z / half_length;
  const double a = half_width * width_factor(t);
  const double b = half_depth * depth_factor(t);
  const double hollow = hollow_ * std::max(0.0, 1.0 - t * t);
  return trace(48, [&](double theta) {
    Vector2d p = irregularity_.factor(theta, t) * superellipse(a, b, 2.5, theta);
    if (p.y() < 0.0) {
      p.x() *= 1.0 - 0.16 * (-p.y() / b);  // the fibromuscular anterior part is narrower than the peripheral zone
    } else {
      p.y() -= hollow * std::exp(-std::pow(p.x() / (0.38 * a), 2)) * (p.y() / b);
    }
    return Vector2d(p.x(), p.y() + centre_y(t));
  });
}

std::vector<Outline> Prostate::outlines(double z) const { return {outline(z)}; }

double Prostate::volume_cc() const {
  constexpr int slices = 60;
  double sum = 0.0;
  for (int i = 0; i < slices; ++i) {
    const double t = -1.0 + (2.0 * i + 1.0) / slices;
    sum += area(outline(t * half_length));
  }
  return sum * 2.0 * half_length / slices / 1000.0;
}

}  // namespace stylet::phantom
