// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/needle_kernel.hpp"

#include "stylet/coupling/near_field/half_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

/// A Gauss–Legendre rule on −½…½.
struct Rule {
  int count;
  std::array<double, 4> point;
  std::array<double, 4> weight;
};
constexpr Rule kOne{1, {0.0}, {1.0}};
constexpr Rule kFour{4,
                     {-0.4305681557970263, -0.1699905217924282, 0.1699905217924282, 0.4305681557970263},
                     {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269}};

/// An image is as smooth as its source is far: beyond this many lengths of a piece its middle will do.
constexpr double kSmooth = 2.0;

/// Displacement under the tip falls over depth at this many times less than would make tissue overtake the tip. At 1 a
/// cut would not unload the tip at all.
constexpr double kDentMargin = 1.5;

NearSurface moved(const NearSurface& skin, const Vec3& way) {
  NearSurface there = skin;
  there.depth = std::max(0.0, there.depth + there.inwards.dot(way));
  return there;
}

}  // namespace

double NeedleKernel::shaft_epsilon() const { return std::sqrt(std::numbers::e) * radius_mm; }

double NeedleKernel::tip_epsilon(double depth, double poisson) const {
  const double deep = 1.5 * radius_mm;
  const double at_surface = (5.0 - 4.0 * poisson) / (2.0 * std::numbers::pi * (1.0 - poisson)) * radius_mm;
  return deep + (at_surface - deep) * std::exp(-depth / radius_mm);
}

Mat3 NeedleKernel::tip_self(const NearSurface& surface, const Medium& medium) const {
  const double epsilon = tip_epsilon(surface.depth, medium.poisson);
  return kelvinlet(Vec3::Zero(), epsilon, medium) + surface_image(Vec3::Zero(), surface, surface, epsilon, medium);
}

Mat3 NeedleKernel::dent(const NearSurface& surface, double press, const Medium& medium) const {
  if (press <= 0.0 || !std::isfinite(surface.depth)) return Mat3::Zero();
  const auto own = [&](double depth) {
    NearSurface there = surface;
    there.depth = depth;
    there.share = 1.0;
    return tip_self(there, medium);
  };
  const auto normal = [&](const Mat3& compliance) { return surface.inwards.dot(compliance * surface.inwards); };
  const Mat3 here = own(surface.depth);
  const Mat3 at_surface = own(0.0);
  const double allowed = normal(at_surface) - surface.depth / (kDentMargin * press);
  const double excess = allowed - normal(here);
  if (excess <= 0.0) return Mat3::Zero();
  return excess / (normal(at_surface) - normal(here)) * (at_surface - here);
}

Mat3 needle_kernel(const Segment& at, const NearSurface& skin_at, const Segment& on, const NearSurface& skin_on,
                   double epsilon, const Medium& medium) {
  const Vec3 direction = at.length == 0.0   ? on.direction
                         : on.length == 0.0 ? at.direction
                                            : (at.direction + on.direction).normalized();
  Mat3 G = kelvinlet(at, on, direction, epsilon, medium);
  if (skin_at.share + skin_on.share == 0.0) return G;
  const bool smooth = skin_at.depth + skin_on.depth > kSmooth * std::max(at.length, on.length);
  const Rule& over_at = smooth || at.length == 0.0 ? kOne : kFour;
  const Rule& over_on = smooth || on.length == 0.0 ? kOne : kFour;
  for (int i = 0; i < over_at.count; ++i) {
    const Vec3 along_at = over_at.point[static_cast<std::size_t>(i)] * at.length * at.direction;
    const NearSurface here = moved(skin_at, along_at);
    for (int j = 0; j < over_on.count; ++j) {
      const Vec3 along_on = over_on.point[static_cast<std::size_t>(j)] * on.length * on.direction;
      const double weight = over_at.weight[static_cast<std::size_t>(i)] * over_on.weight[static_cast<std::size_t>(j)];
      G += weight *
           surface_image(at.centre + along_at - on.centre - along_on, here, moved(skin_on, along_on), epsilon, medium);
    }
  }
  return G;
}

}  // namespace stylet
