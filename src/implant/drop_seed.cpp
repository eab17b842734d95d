// SPDX-License-Identifier: GPL-3.0-or-later
#include "drop_seed.hpp"

namespace stylet {

namespace {

constexpr double kExact_mm = 1e-10;
constexpr int kMostIterations = 400;

}  // namespace

std::optional<FoundMaterial> material_at(const Vec3& place, const DisplacementAt& displacement) {
  FoundMaterial found;
  found.x = place;
  double step = 1.0;
  double last = 1e300;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const auto u = displacement(found.x);
    if (!u) return std::nullopt;
    found.moved = *u;
    const Vec3 off = place - found.x - u->whole;
    if (off.norm() < kExact_mm) return found;
    // Right beside the needle the displacement changes within its radius, and full steps may go to and fro.
    if (off.norm() > 0.9 * last) step = std::max(0.2, 0.7 * step);
    last = off.norm();
    found.x += step * off;
  }
  return std::nullopt;
}

DisplacementAt displacement_in(Simulation& simulation) {
  return [&simulation](const Vec3& x) -> std::optional<Insertion::PointDisplacement> {
    const auto at = simulation.model().locator().find(x);
    if (!at) return std::nullopt;
    return simulation.displacement_at(*at, x);
  };
}

}  // namespace stylet
