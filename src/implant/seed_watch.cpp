// SPDX-License-Identifier: GPL-3.0-or-later
#include "seed_watch.hpp"

#include "drop_seed.hpp"

namespace stylet {

SeedWatch::SeedWatch(const NeedleLoad& load, const NeedleMotion& motion, const Scenario& scenario,
                     double seed_length_mm)
    : load_(load), motion_(motion), technique_(scenario.procedure.technique), seed_length_mm_(seed_length_mm) {
  for (const LoadedSeed& loaded : load.seeds) {
    Seed seed;
    seed.history.number = loaded.number;
    seed.history.planned_mm = loaded.planned_mm;
    seed.history.dropped_mm = loaded.planned_mm;
    seed.history.rest_mm = loaded.planned_mm;
    seed.history.axis = loaded.axis;
    seed.history.in_tissue = false;
    seeds_.push_back(seed);
  }
}

void SeedWatch::place(Seed& seed, const Needle& needle, double arc_mm) {
  const double length = needle.length();
  const Vec3 tangent = needle.tangent(std::min(arc_mm, length));
  seed.history.dropped_mm = needle.point(std::min(arc_mm, length)) + std::max(0.0, arc_mm - length) * tangent;
  seed.axis = tangent;
  seed.is_placed = true;
}

/// Finds the tissue at the seed.
void SeedWatch::leave(Seed& seed, Simulation& simulation, double since_start_s) {
  seed.is_left = true;
  left_.push_back(seed.history.number);
  SeedHistory& h = seed.history;
  h.dropped_s = since_start_s;
  const TissueAt tissue = tissue_of_capsule(h.dropped_mm, seed.axis, seed_length_mm_, displacement_in(simulation));
  h.in_tissue = tissue.is_known;
  h.rest_mm = tissue.rest_mm;
  h.axis = tissue.axis;
  h.explain(load_.aim_mm, tissue.lasting_mm);
}

void SeedWatch::add(Simulation& simulation, double since_start_s) {
  if (motion_.drops.empty()) return;
  const Needle& needle = simulation.insertion().needle();
  for (std::size_t k = 0; k < seeds_.size(); ++k) {
    Seed& seed = seeds_[k];
    // The last step before the base moves on.
    if (seed.is_left || since_start_s + simulation.last_step().dt_s <= motion_.drops[k].time_s + 1e-9) continue;
    if (technique_ == SeedTechnique::pushed) {
      place(seed, needle, needle.length() + 0.5 * seed_length_mm_);
      leave(seed, simulation, since_start_s);
      continue;
    }
    if (!seed.is_placed) place(seed, needle, needle.length() - load_.seeds[k].behind_tip_mm);
    const double beyond_tip = (seed.history.dropped_mm - needle.point(needle.length())).dot(seed.axis);
    if (beyond_tip >= 0.5 * seed_length_mm_) leave(seed, simulation, since_start_s);
  }
}

std::vector<SeedHistory> SeedWatch::result() const {
  std::vector<SeedHistory> all;
  for (const Seed& seed : seeds_) all.push_back(seed.history);
  return all;
}

}  // namespace stylet
