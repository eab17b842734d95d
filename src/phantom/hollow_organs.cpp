// SPDX-License-Identifier: GPL-3.0-or-later
// Urethra, bladder, rectum.
#include "anatomy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stylet::phantom {

using Eigen::Vector2d;

// --- Urethra: from the bladder neck backwards to the verumontanum, then forwards through apex and pelvic floor.

Urethra::Urethra(const Sizes& sizes, const Prostate& prostate)
    : Organ("Urethra", "ORGAN", {240, 200, 60}),
      half_length_(prostate.half_length),
      radius_(0.5 * sizes.urethra_diameter) {
  low = -1.72 * half_length_;
  high = 1.04 * half_length_;  // the neck: half a slice into the lowest contour of the bladder
}

double Urethra::centre(double z) const {
  static constexpr std::array<double, 7> knots{-1.80, -1.40, -0.95, -0.50, -0.10, 0.45, 1.05};  // × half length
  static constexpr std::array<double, 7> y{-9.0, -5.2, -1.8, 1.4, 2.4, 0.6, -3.6};              // [mm]
  return interpolate(knots, y, z / half_length_);
}

std::vector<Outline> Urethra::outlines(double z) const {
  // Crescent-like inside the gland, round below it.
  const double flat = z > -half_length_ ? 0.06 : 0.0;
  const double y = centre(z);
  return {trace(24, [&](double theta) {
    return Vector2d(radius_ * (1.0 + flat) * std::cos(theta), y + radius_ * (1.0 - flat) * std::sin(theta));
  })};
}

// --- Bladder: a funnel at the neck, widest in its middle, leaning forwards over the symphysis.

namespace {
constexpr double bladder_half_width = 36.0;  // [mm] before scaling to the volume
constexpr double bladder_half_depth = 28.0;
constexpr double bladder_height = 52.0;
}  // namespace

Bladder::Bladder(const Sizes& sizes, const Prostate& prostate, Random& random)
    : Organ("Bladder", "ORGAN", {90, 150, 230}), irregularity_(random, 0.04) {
  low = prostate.half_length + 0.8;
  constexpr int slices = 50;
  for (int repeat = 0; repeat < 3; ++repeat) {
    high = low + scale_ * bladder_height;
    double volume = 0.0;
    for (int i = 0; i < slices; ++i) volume += area(outline(low + (i + 0.5) * (high - low) / slices));
    scale_ *= std::cbrt(sizes.bladder_cc * 1000.0 / (volume * (high - low) / slices));
  }
  high = low + 0.985 * scale_ * bladder_height;
}

Outline Bladder::outline(double z) const {
  const double t = std::clamp((z - low) / (scale_ * bladder_height), 0.0, 1.0);
  // The neck (t = 0) is a funnel of finite width; the dome (t = 1) is round.
  const double u = 2.0 * t - 1.0;
  const double size = std::sqrt(std::max(1.0 - std::pow(std::abs(u), 2.3), u < 0.0 ? 0.10 : 0.0));
  const double lean = -3.6 - 12.0 * std::sin(0.5 * std::numbers::pi * t) * t;
  return trace(48, [&](double theta) {
    const Vector2d p =
        superellipse(scale_ * bladder_half_width * size, scale_ * bladder_half_depth * size, 2.25, theta);
    return Vector2d(irregularity_.factor(theta, 2.0 * t) * p + Vector2d(0.0, lean));
  });
}

std::vector<Outline> Bladder::outlines(double z) const { return {outline(z)}; }

// --- Rectum and anal canal: along the sacral hollow, bent backwards at the anorectal junction below the apex.

namespace {
// Heights are in half lengths of the gland. The anterior wall [mm] is for a gland 17 mm deep with a gap of 4 mm.
constexpr std::array<double, 9> rectum_heights{-1.95, -1.40, -0.93, -0.47, 0.0, 0.7, 1.63, 2.56, 3.4};
constexpr std::array<double, 9> rectum_front{38.0, 27.5, 20.5, 20.0, 21.0, 22.5, 27.0, 32.5, 37.0};
constexpr std::array<double, 9> rectum_half_width{9.0, 10.5, 14.0, 16.5, 17.0, 17.0, 18.0, 18.5, 17.5};
constexpr std::array<double, 9> rectum_half_depth{10.5, 12.0, 13.0, 13.0, 13.0, 13.5, 15.0, 15.5, 15.0};
}  // namespace

Rectum::Rectum(const Sizes& sizes, const Prostate& prostate, Random& random)
    : Organ("Rectum", "ORGAN", {150, 110, 70}),
      unit_(prostate.half_length),
      front_(prostate.half_depth - 17.0 + sizes.rectum_gap - 4.0),
      scale_(sizes.rectum_diameter / 30.0),
      irregularity_(random, 0.05) {
  const double skin = -unit_ - sizes.skin_below_apex;
  low = std::max(rectum_heights.front() * unit_, skin + 11.0);  // contours of the canal end above the anal verge
  high = 70.0;
}

std::vector<Outline> Rectum::outlines(double z) const {
  const double h = z / unit_;
  const double a = scale_ * interpolate(rectum_heights, rectum_half_width, h);
  const double b = scale_ * interpolate(rectum_heights, rectum_half_depth, h);
  const double front = front_ + interpolate(rectum_heights, rectum_front, h);
  return {trace(40, [&](double theta) {
    const Vector2d p = irregularity_.factor(theta, 0.6 * h) * superellipse(a, b, 2.3, theta);
    // The anterior wall is flat against the gland; the posterior wall is round.
    const double y = p.y() < 0.0 ? p.y() * (1.0 - 0.12 * (1.0 - std::pow(p.x() / a, 2))) : p.y();
    return Vector2d(p.x(), front + 0.88 * b + y);
  })};
}

}  // namespace stylet::phantom
