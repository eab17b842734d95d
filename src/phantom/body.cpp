// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::phantom {

using Eigen::Vector2d;

namespace {
constexpr double body_centre_y = 9.0;    // [mm] the gland is nearer to the anterior surface
constexpr double perineum_start = 34.0;  // [mm] height above the skin at which sections begin to shrink
constexpr double roundness = 2.6;        // exponent of the perineum; 2 is an ellipsoid's cap, larger values are flatter
}  // namespace

Body::Body(const Sizes& sizes, const Prostate& prostate, Random& random)
    : Organ("Body", "EXTERNAL", {235, 195, 165}),
      half_width_(0.5 * sizes.body_width),
      half_depth_(0.5 * sizes.body_depth),
      irregularity_(random, 0.02) {
  low = -prostate.half_length - sizes.skin_below_apex;
  high = 82.0;
}

std::vector<Outline> Body::outlines(double z) const {
  // The lowest point of the skin is at `low`; sections there are round and still wide enough to draw.
  const double u = std::clamp((low + perineum_start - z) / perineum_start, 0.0, 0.99);
  const double size = std::pow(1.0 - std::pow(u, roundness), 1.0 / roundness);
  const double squareness = 2.6 - 0.4 * u;
  const double y = body_centre_y - 5.0 * u * u;  // the perineum is centred anteriorly of the anus
  const double cleft = 5.0 * std::exp(-std::pow((z + 5.0) / 40.0, 2));
  return {trace(72, [&](double theta) {
    Vector2d p =
        irregularity_.factor(theta, z / 60.0) * size * superellipse(half_width_, half_depth_, squareness, theta);
    // Natal cleft, posteriorly.
    if (p.y() > 0.0)
      p.y() -= cleft * size * std::exp(-std::pow(p.x() / (0.14 * half_width_), 2)) * (p.y() / (half_depth_ * size));
    return Vector2d(p.x(), p.y() + y);
  })};
}

}  // namespace stylet::phantom
