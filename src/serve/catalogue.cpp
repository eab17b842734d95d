// SPDX-License-Identifier: GPL-3.0-or-later
#include "catalogue.hpp"

#include <cmath>
#include <system_error>

namespace stylet::serve {
namespace fs = std::filesystem;

namespace {

CatalogueEntry entry_of(const std::string& name, const Result<RecordingHead>& head) {
  CatalogueEntry entry;
  entry.name = name;
  if (!head) {
    entry.problem = head.error().what;
    return entry;
  }
  entry.of_case = head->scenario_name;
  entry.duration_s = head->duration_s;
  entry.has_ended = head->has_ended;
  entry.most_N = head->most_N;
  if (!head->implant) return entry;
  const RecordedImplant& implant = *head->implant;
  const RecordedPlan& plan = implant.plan;
  if (plan.current >= 0) entry.needle = plan.needles[static_cast<std::size_t>(plan.current)].name;
  entry.has_plan = true;
  entry.planned_seeds = plan.seeds.size();
  entry.seeds = implant.acts_of_seeds(implant.acts.size()).size();
  const auto dose = implant.dose_after(static_cast<std::int64_t>(implant.acts.size()));
  if (dose && std::isfinite(dose->d90_percent)) entry.d90_percent = dose->d90_percent;
  return entry;
}

}  // namespace

std::vector<CatalogueEntry> Catalogue::list() {
  const std::lock_guard lock(mutex_);
  const std::vector<std::string> names = shelf_.names();
  std::map<std::string, Kept> now;
  std::vector<std::string> changed;
  for (const std::string& name : names) {
    std::error_code code;
    const fs::path file = shelf_.folder(name) / "run.h5";
    Kept kept{fs::file_size(file, code), fs::last_write_time(file, code), {}};
    const auto known = kept_.find(name);
    const bool is_same = known != kept_.end() && known->second.bytes == kept.bytes &&
                         known->second.written == kept.written && known->second.entry.problem.empty();
    if (is_same) {
      kept.entry = known->second.entry;
    } else {
      changed.push_back(name);
    }
    now.emplace(name, std::move(kept));
  }
  const auto heads = shelf_.heads(changed);
  for (std::size_t k = 0; k < changed.size(); ++k) now.at(changed[k]).entry = entry_of(changed[k], heads[k]);
  kept_ = std::move(now);
  std::vector<CatalogueEntry> entries;
  for (const std::string& name : names) entries.push_back(kept_.at(name).entry);
  return entries;
}

}  // namespace stylet::serve
