// SPDX-License-Identifier: GPL-3.0-or-later
#include "drop_seed.hpp"

#include <algorithm>

namespace stylet {

namespace {

constexpr double kExact_mm = 1e-10;
/// Where the displacement jumps from element to element, no point may be exactly at the place; the nearest one is taken
/// if it is nearer than this.
constexpr double kNearEnough_mm = 0.2;
constexpr int kMostIterations = 150;

}  // namespace

std::optional<FoundMaterial> material_at(const Vec3& place, const DisplacementAt& displacement) {
  std::optional<FoundMaterial> nearest;
  double least = kNearEnough_mm;
  Vec3 x = place;
  double step = 1.0;
  double last = 1e300;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const auto u = displacement(x);
    if (!u) return nearest;
    const Vec3 off = place - x - u->whole;
    if (off.norm() < least) {
      least = off.norm();
      nearest = FoundMaterial{x, *u};
      if (least < kExact_mm) return nearest;
    }
    // Right beside the needle the displacement changes within its radius, and full steps may overshoot.
    if (off.norm() > 0.9 * last) step = std::max(0.05, 0.7 * step);
    last = off.norm();
    x += step * off;
  }
  return nearest;
}

DisplacementAt displacement_in(Simulation& simulation) {
  return [&simulation](const Vec3& x) -> std::optional<Insertion::PointDisplacement> {
    const auto at = simulation.model().locator().find(x);
    if (!at) return std::nullopt;
    return simulation.displacement_at(*at, x);
  };
}

}  // namespace stylet
