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

/// Finds the tissue at the seed: at its centre, and at its ends for its axis.
void SeedWatch::leave(Seed& seed, Simulation& simulation, double since_start_s) {
  seed.is_left = true;
  left_.push_back(seed.history.number);
  SeedHistory& h = seed.history;
  h.dropped_s = since_start_s;
  const DisplacementAt displacement = displacement_in(simulation);
  const auto centre = material_at(h.dropped_mm, displacement);
  h.in_tissue = centre.has_value();
  // What the nearest material point misses of the place counts as motion of the tissue.
  h.rest_mm = centre ? Vec3(h.dropped_mm - centre->moved.whole) : h.dropped_mm;
  h.by(SeedCause::aim) = load_.aim_mm;
  h.by(SeedCause::bend) = h.dropped_mm - h.planned_mm - load_.aim_mm;
  h.by(SeedCause::relaxation) = centre ? Vec3(-centre->moved.lasting) : Vec3::Zero();
  h.by(SeedCause::motion) = h.rest_mm - h.dropped_mm - h.by(SeedCause::relaxation);
  const Vec3 half = 0.5 * seed_length_mm_ * seed.axis;
  const auto front = material_at(h.dropped_mm + half, displacement);
  const auto back = material_at(h.dropped_mm - half, displacement);
  h.axis = front && back && (front->x - back->x).norm() > 0.0 ? (front->x - back->x).normalized() : seed.axis;
}

void SeedWatch::add(Simulation& simulation, double since_start_s) {
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
