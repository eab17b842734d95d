// SPDX-License-Identifier: GPL-3.0-or-later
#include "seed_journal.hpp"

#include <algorithm>
#include <cstddef>

namespace stylet::serve {

SeedJournal::News SeedJournal::news(const LiveImplant& implant, bool score_is_current, double time_s) {
  News out;
  std::vector<SeedAct> settled;
  std::size_t same = 0;
  while (same < std::min(seeds_.size(), implant.seeds.size()) && seeds_[same].is_same_drop(implant.seeds[same])) ++same;
  last_s_ = std::max(last_s_, has_begun_ ? time_s : 0.0);
  while (seeds_.size() > same) {
    out.acts.push_back({SeedAct::Kind::taken_back, last_s_, seeds_.back()});
    seeds_.pop_back();
  }
  for (std::size_t k = 0; k < same; ++k) {
    const SeedHistory& seed = implant.seeds[k];
    if (seeds_[k].rest_mm == seed.rest_mm) continue;
    seeds_[k] = seed;
    settled.push_back({SeedAct::Kind::settled, 0.0, seed});
  }
  for (std::size_t k = same; k < implant.seeds.size(); ++k) {
    const SeedHistory& seed = implant.seeds[k];
    // The loop may be further than the steps that have been fetched.
    if (has_begun_) last_s_ = std::max(last_s_, seed.dropped_s);
    out.acts.push_back({has_begun_ ? SeedAct::Kind::dropped : SeedAct::Kind::earlier, last_s_, seed});
    seeds_.push_back(seed);
  }
  has_begun_ = true;
  for (SeedAct& act : settled) {
    act.time_s = last_s_;
    out.acts.push_back(act);
  }
  acts_ += static_cast<std::int64_t>(out.acts.size());
  if (implant.planned && !has_plan_dose_) {
    has_plan_dose_ = true;
    out.doses.emplace_back(*implant.planned).acts = RecordedScore::kOfPlan;
  }
  if (implant.now && score_is_current && dose_after_ != acts_) {
    dose_after_ = acts_;
    out.doses.emplace_back(*implant.now).acts = acts_;
  }
  return out;
}

}  // namespace stylet::serve
