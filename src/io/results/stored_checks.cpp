// SPDX-License-Identifier: GPL-3.0-or-later
#include "stored_checks.hpp"

namespace stylet::results {

std::optional<RunEnd> end_of(const record::Rows<RunEnd>& rows) {
  if (rows.size() == 0) return std::nullopt;
  expect(rows.size() == 1 && rows.is_whole(0), "/end");
  return record_at(rows, 0, "/end");
}

std::optional<RecordedImplant> implant_of(const StoredSeeds& stored, const std::optional<RunEnd>& end) {
  if (stored.plan.needles.size() == 0) {
    expect(!end || (end->acts == 0 && end->doses == 0), "/implant");
    return std::nullopt;
  }
  expect(stored.digest == plan_digest(stored.plan), "/implant: the plan");
  RecordedImplant out{stored.plan.head, {}, {}};
  RecordedPlan& plan = out.plan;
  for (std::size_t k = 0; k < stored.plan.needles.size(); ++k)
    plan.needles.push_back(record_at(stored.plan.needles, k, "/implant/needles"));
  for (std::size_t k = 0; k < stored.plan.seeds.size(); ++k) {
    plan.seeds.push_back(record_at(stored.plan.seeds, k, "/implant/planned_seeds"));
    expect(plan.seeds.back().needle < plan.needles.size(), "/implant/planned_seeds: needle");
  }
  expect(plan.current >= -1 && plan.current < static_cast<int>(plan.needles.size()), "/implant: current");
  out.acts = whole_records(
      stored.acts, [&](std::size_t k) { return stored.acts.is_whole(k); }, said_by(end, &RunEnd::acts),
      "/implant/acts");
  for (const SeedAct& act : out.acts) expect(act.seed.needle < plan.needles.size(), "/implant/acts: needle");
  out.doses = whole_records(
      stored.doses, [&](std::size_t k) { return stored.doses.is_whole(k); }, said_by(end, &RunEnd::doses),
      "/implant/doses");
  return out;
}

}  // namespace stylet::results
