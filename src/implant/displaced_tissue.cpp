// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/displaced_tissue.hpp"

namespace stylet {

namespace {

/// The axis of a seed whose ends are moved. @param move function: the new place of a point
template <class Move>
Vec3 moved_axis(const Vec3& centre, const Vec3& axis, double length_mm, const Move& move) {
  const Vec3 half = 0.5 * length_mm * axis;
  return (move(centre + half) - move(centre - half)).normalized();
}

}  // namespace

void let_tissue_go_back(const Locator& locator, const NodalDisplacement& u, double seed_length_mm,
                        std::span<SeedHistory> seeds) {
  const auto back = [&](const Vec3& x) { return undeformed(locator, u, x); };
  for (SeedHistory& seed : seeds) {
    if (seed.lost) continue;
    const Vec3 rest_mm = back(seed.rest_mm);
    seed.axis = moved_axis(seed.rest_mm, seed.axis, seed_length_mm, back);
    seed.by(SeedCause::probe) += rest_mm - seed.rest_mm;
    seed.rest_mm = rest_mm;
  }
}

DosePlan displaced(const Locator& locator, const NodalDisplacement& u, double seed_length_mm, DosePlan plan) {
  const auto along = [&](const Vec3& x) { return displaced_place(locator, u, x); };
  for (PlannedSource& source : plan.sources) {
    if (source.has_axis) source.axis = moved_axis(source.at_mm, source.axis, seed_length_mm, along);
    source.at_mm = along(source.at_mm);
  }
  return plan;
}

DoseStructure displaced(const Locator& locator, const NodalDisplacement& u, DoseStructure structure) {
  for (Vec3& x : structure.samples.points) x = displaced_place(locator, u, x);
  return structure;
}

}  // namespace stylet
