// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/compensation.hpp"

#include "stylet/implant/seed_errors.hpp"

namespace stylet {

namespace {

/// Corrects the aim of each needle by the mean error of its seeds.
void correct(std::vector<NeedleLoad>& needles, const ImplantHistory& history) {
  for (std::size_t k = 0; k < needles.size(); ++k) {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (const SeedHistory& seed : history.seeds) {
      if (seed.needle != k || !seed.in_tissue) continue;
      // A jump at random cannot be aimed at.
      sum += seed.error_mm() - seed.by(SeedCause::release);
      ++count;
    }
    if (count > 0) aim(needles[k], -sum / count);
  }
}

}  // namespace

Result<Compensation> compensate(std::vector<NeedleLoad> needles, int rounds, const SimulateNeedles& simulate) {
  Result<ImplantHistory> now = simulate(needles);
  if (!now) return now.error();
  Compensation out{*now, *now, needles};
  for (int round = 0; round < rounds; ++round) {
    correct(needles, *now);
    now = simulate(needles);
    if (!now) return now.error();
    if (seed_errors(now->seeds).mean_mm >= seed_errors(out.after.seeds).mean_mm) continue;
    out.after = *now;
    out.needles = needles;
  }
  return out;
}

}  // namespace stylet
