// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/recorded_implant.hpp"

#include "stylet/sim/harms.hpp"

#include <algorithm>

namespace stylet {

void TallyOfNeedle::add(const Event& event, ImplantTally& tally) {
  switch (event.kind) {
    case EventKind::skin_contact:
      touched_ = event.region;
      break;
    case EventKind::puncture:
      if (!event.region.empty() && event.region == touched_) ++tally.skin_punctures;
      touched_.clear();
      break;
    case EventKind::withdrawn:
      touched_.clear();
      break;
    case EventKind::region_entered:
      if (harmed_by_needle(event.region)) ++tally.organ_entries;
      break;
    case EventKind::bone_contact:
      ++tally.bone_contacts;
      break;
    case EventKind::exited:
      ++tally.exits;
      break;
    default:
      break;
  }
}

const char* to_string(SeedAct::Kind kind) {
  switch (kind) {
    case SeedAct::Kind::earlier:
      return "earlier";
    case SeedAct::Kind::dropped:
      return "dropped";
    case SeedAct::Kind::taken_back:
      return "taken_back";
    case SeedAct::Kind::settled:
      return "settled";
  }
  return "";
}

std::size_t RecordedImplant::acts_until(double time_s) const {
  const auto after = std::find_if(acts.begin(), acts.end(), [&](const SeedAct& act) { return act.time_s > time_s; });
  return static_cast<std::size_t>(after - acts.begin());
}

std::vector<std::size_t> RecordedImplant::acts_of_seeds(std::size_t count) const {
  std::vector<std::size_t> there;
  for (std::size_t k = 0; k < std::min(count, acts.size()); ++k) {
    const SeedAct& act = acts[k];
    if (act.kind == SeedAct::Kind::taken_back) {
      if (!there.empty()) there.pop_back();
    } else if (act.kind == SeedAct::Kind::settled) {
      for (std::size_t& of : there)
        if (acts[of].seed.is_same_drop(act.seed)) of = k;
    } else {
      there.push_back(k);
    }
  }
  return there;
}

std::vector<SeedHistory> RecordedImplant::seeds_after(std::size_t count) const {
  std::vector<SeedHistory> seeds;
  for (const std::size_t act : acts_of_seeds(count)) seeds.push_back(acts[act].seed);
  return seeds;
}

std::optional<RecordedScore> RecordedImplant::dose_after(std::int64_t count) const {
  const auto found =
      std::find_if(doses.rbegin(), doses.rend(), [&](const RecordedScore& d) { return d.acts == count; });
  if (found == doses.rend()) return std::nullopt;
  return *found;
}

}  // namespace stylet
