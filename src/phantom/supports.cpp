// SPDX-License-Identifier: GPL-3.0-or-later
// The pubic arch, and the band that ties the gland to it.
#include "anatomy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::phantom {

using Eigen::Vector2d;

namespace {

constexpr double symphysis_half_depth = 8.5;  // [mm] anterior to posterior
constexpr double symphysis_high = 32.0;       // [mm] upper end
constexpr double symphysis_incline = 0.25;    // -dy/dz: the upper end is further anterior
constexpr double ramus_half_length = 10.5;    // [mm] in a transverse section
constexpr double ramus_half_thickness = 5.5;  // [mm]
constexpr double rami_height = 31.0;  // [mm] height from the lower end of the symphysis to the ischial tuberosities

}  // namespace

PubicArch::PubicArch(const Sizes& sizes, const Prostate& prostate, Random& random)
    : Organ("Pubic arch", "ORGAN", {225, 220, 195}),
      front_shift_(-prostate.half_depth - sizes.retropubic_gap),
      spread_(std::tan(0.5 * sizes.subpubic_angle * std::numbers::pi / 180.0)),
      start_x_(12.5 + 0.5 * (prostate.half_width - 23.0)),
      irregularity_(random, 0.03) {
  symphysis_low = -0.5 * prostate.half_length - 0.5;
  low = symphysis_low - rami_height;
  high = symphysis_high;
}

double PubicArch::back(double z) const { return front_shift_ - symphysis_incline * std::max(z, symphysis_low); }

/// Section of the symphysis: a slab bent backwards at its sides, consisting of both pubic bodies.
Outline PubicArch::symphysis(double z) const {
  const double t = (z - symphysis_low) / (symphysis_high - symphysis_low);  // 0 lower end … 1 upper end
  const double half_width = 23.0 + 8.0 * std::sin(std::numbers::pi * std::min(1.0, 0.75 * t)) - 6.0 * std::pow(t, 6);
  const double half_depth = symphysis_half_depth * (1.0 - 0.3 * std::pow(t, 6));
  const double bend = 0.022 - 0.012 * t;  // [1/mm]
  const double middle = back(z) - symphysis_half_depth;
  return trace(64, [&](double theta) {
    const Vector2d p = irregularity_.factor(theta, t) * superellipse(half_width, half_depth, 3.2, theta);
    return Vector2d(p.x(), middle + p.y() + bend * p.x() * p.x());
  });
}

/// Oblique section of one ischiopubic ramus, which runs outwards, downwards and backwards.
/// @param side +1 left, -1 right
Outline PubicArch::ramus(double z, double side) const {
  const double down = symphysis_low - z;
  const double s = down / rami_height;
  const double x = start_x_ + 1.65 * spread_ * down;
  const double y = back(symphysis_low) - symphysis_half_depth + 3.0 + 1.62 * spread_ * down + 3.0 * s * s;
  const double taper = 1.0 - 0.35 * std::pow(s, 4);
  const double angle = (40.0 + 10.0 * s) * std::numbers::pi / 180.0;
  Outline outline = trace(36, [&](double theta) {
    const Vector2d p = irregularity_.factor(theta + side, s) *
                       superellipse(taper * ramus_half_length, taper * ramus_half_thickness, 2.3, theta);
    return Vector2d(side * (x + std::cos(angle) * p.x() - std::sin(angle) * p.y()),
                    y + std::sin(angle) * p.x() + std::cos(angle) * p.y());
  });
  if (side < 0.0) std::reverse(outline.begin(), outline.end());  // mirroring has made it clockwise
  return outline;
}

std::vector<Outline> PubicArch::outlines(double z) const {
  if (z >= symphysis_low) return {symphysis(z)};
  return {ramus(z, +1.0), ramus(z, -1.0)};
}

Band::Band(const Prostate& prostate, const Urethra& urethra, const PubicArch& arch)
    : Organ("Band", "ORGAN", {190, 120, 200}), prostate_(prostate), urethra_(urethra), arch_(arch) {
  low = -0.95 * prostate.half_length;
  high = -0.15 * prostate.half_length;
}

std::vector<Outline> Band::outlines(double z) const {
  constexpr double into_gland = 3.0, into_arch = 3.0;  // [mm] overlap at either end
  constexpr double before_urethra = 1.3;               // [mm] distance to the urethra
  const double rear = std::min(prostate_.front(z) + into_gland, urethra_.front(z) - before_urethra);
  const double front = arch_.back(z) - into_arch;
  const double t = (z - low) / (high - low);
  const double half_width = 6.0 + 1.5 * std::sin(std::numbers::pi * t);
  return {trace(32, [&](double theta) {
    return Vector2d(superellipse(half_width, 0.5 * (rear - front), 4.0, theta) + Vector2d(0.0, 0.5 * (rear + front)));
  })};
}

}  // namespace stylet::phantom
