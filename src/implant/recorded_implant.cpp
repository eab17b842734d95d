// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/recorded_implant.hpp"

#include <algorithm>

namespace stylet {

const char* to_string(SeedAct::Kind kind) {
  switch (kind) {
    case SeedAct::Kind::earlier:
      return "earlier";
    case SeedAct::Kind::dropped:
      return "dropped";
    case SeedAct::Kind::taken_back:
      return "taken_back";
  }
  return "";
}

std::size_t RecordedImplant::acts_until(double time_s) const {
  const auto after = std::find_if(acts.begin(), acts.end(), [&](const SeedAct& act) { return act.time_s > time_s; });
  return static_cast<std::size_t>(after - acts.begin());
}

std::vector<SeedHistory> RecordedImplant::seeds_after(std::size_t count) const {
  std::vector<SeedHistory> seeds;
  for (std::size_t k = 0; k < std::min(count, acts.size()); ++k) {
    if (acts[k].kind != SeedAct::Kind::taken_back) {
      seeds.push_back(acts[k].seed);
    } else if (!seeds.empty()) {
      seeds.pop_back();
    }
  }
  return seeds;
}

std::optional<RecordedScore> RecordedImplant::dose_after(std::int64_t count) const {
  const auto found =
      std::find_if(doses.rbegin(), doses.rend(), [&](const RecordedScore& d) { return d.acts == count; });
  if (found == doses.rend()) return std::nullopt;
  return *found;
}

}  // namespace stylet
