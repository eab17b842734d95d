// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/implant.hpp"

#include "needle_group.hpp"
#include "sim/planning.hpp"
#include "stylet/core/parallel.hpp"
#include "stylet/geom/centroid.hpp"
#include "stylet/geom/topology.hpp"
#include "stylet/implant/needle_insertion.hpp"
#include "stylet/implant/seed_fate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

namespace stylet {

namespace {

/// Largest total number of nodes of the meshes whose models are compiled in parallel; it limits the memory.
constexpr Index kNodesAtOnce = 40000;
/// [mm] Needles whose planned tips differ less than this in height are a row of the template.
constexpr double kSameRow_mm = 1.0;

/// Needles that are in the tissue together, by their numbers.
using Together = std::vector<std::size_t>;

std::vector<Together> groups_of(const std::vector<NeedleLoad>& needles, NeedlesTogether together) {
  if (!needles.empty() && needles.front().implant == Implant::temporary) together = NeedlesTogether::all;
  std::vector<Together> groups;
  for (std::size_t k = 0; k < needles.size(); ++k) {
    const auto with_this = std::find_if(groups.begin(), groups.end(), [&](const Together& group) {
      return together == NeedlesTogether::all ||
             (together == NeedlesTogether::row &&
              std::abs(needles[group.front()].tip_mm.y() - needles[k].tip_mm.y()) < kSameRow_mm);
    });
    if (with_this == groups.end()) {
      groups.push_back({k});
    } else {
      with_this->push_back(k);
    }
  }
  return groups;
}

/// The stabilising needles: through their holes, as deep as the deepest needle of the plan.
Result<std::vector<NeedleLoad>> stabilising_needles(const Scenario& scenario, const TetMesh& mesh,
                                                    const std::vector<NeedleLoad>& needles) {
  std::vector<NeedleLoad> staying;
  double deepest = -std::numeric_limits<double>::infinity();
  for (const NeedleLoad& load : needles) deepest = std::max(deepest, load.tip_mm.z());
  for (const std::string& hole : scenario.procedure.stabilising) {
    const auto on_line = point_behind_hole(scenario.grid, hole, centroid(mesh, find_target(mesh)));
    if (!on_line) return on_line.error();
    NeedleLoad load;
    load.name = "stabilising " + hole;
    load.tip_mm = Vec3(on_line->x(), on_line->y(), deepest);
    staying.push_back(load);
  }
  return staying;
}

}  // namespace

Implant implant_of(std::span<const SeedHistory> seeds) {
  const bool dwells =
      std::any_of(seeds.begin(), seeds.end(), [](const SeedHistory& seed) { return seed.at_planning.has_value(); });
  return dwells ? Implant::temporary : Implant::permanent;
}

Result<ImplantHistory> simulate_implant(const Scenario& scenario, const TetMesh& mesh,
                                        const std::vector<NeedleLoad>& needles, double seed_length_mm,
                                        const std::string& where, const Progress& progress) {
  const bool catheters = !needles.empty() && needles.front().implant == Implant::temporary;
  if (catheters && (scenario.coupling.solver != CouplingSettings::Solver::coupled ||
                    scenario.coupling.engine != CouplingSettings::Engine::condensed)) {
    return input_error(where,
                       fmt::format("the catheters of a temporary implant stay in the tissue together, and "
                                   "coupling.solver = \"{}\" with coupling.engine = \"{}\" holds one needle only",
                                   word(scenario.coupling.solver), word(scenario.coupling.engine)),
                       "Leave coupling.solver and coupling.engine out");
  }
  const Topology topology(mesh);
  const Locator locator(mesh, topology);
  const Result<std::vector<NeedleLoad>> staying = stabilising_needles(scenario, mesh, needles);
  if (!staying) return staying.error();
  const auto with_plan = [&](const NeedleLoad& load) -> Result<PlannedNeedle> {
    const Result<InsertionPlan> plan = needle_insertion(load, scenario, locator, where);
    if (!plan) return plan.error();
    return PlannedNeedle{&load, *plan};
  };
  std::vector<PlannedNeedle> stays;
  for (const NeedleLoad& load : *staying) {
    const Result<PlannedNeedle> planned = with_plan(load);
    if (!planned) return planned.error();
    stays.push_back(*planned);
  }
  const std::vector<Together> groups = groups_of(needles, scenario.procedure.together);
  std::vector<std::vector<PlannedNeedle>> together(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const std::size_t k : groups[g]) {
      const Result<PlannedNeedle> planned = with_plan(needles[k]);
      if (!planned) return planned.error();
      together[g].push_back(*planned);
    }
  }
  KnownTargets targets;
  std::vector<std::optional<Result<GroupOutcome>>> done(groups.size());
  const auto caller = std::this_thread::get_id();
  const auto lanes = static_cast<std::size_t>(std::max<Index>(1, kNodesAtOnce / std::max<Index>(1, mesh.node_count())));
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> finished = 0;
  std::atomic<bool> failed = false;
  for_each_in_parallel(std::min(lanes, groups.size()), [&](std::size_t /*lane*/) {
    for (std::size_t g = next++; g < groups.size() && !failed; g = next++) {
      if (std::this_thread::get_id() == caller) {
        const std::size_t first = groups[g].front();
        report(progress,
               catheters ? fmt::format("{} catheters, which stay together", needles.size())
                         : fmt::format("needle {} of {}, {}", first + 1, needles.size(), needles[first].name),
               static_cast<double>(finished) / static_cast<double>(needles.size()));
      }
      done[g] = simulate_group(stays, together[g], scenario, mesh, seed_length_mm, targets, where);
      if (!done[g]->ok()) failed = true;
      finished += groups[g].size();
    }
  });
  ImplantHistory history;
  history.nodes = static_cast<int>(mesh.node_count());
  history.needles.resize(needles.size());
  std::vector<std::vector<std::string>> warnings(needles.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!done[g]) continue;
    if (!done[g]->ok()) return done[g]->error();
    GroupOutcome& outcome = **done[g];
    history.compile_s += outcome.compile_s;
    if (g == 0) {
      history.warnings = outcome.warnings;
      history.stabilising = std::move(outcome.staying);
    }
    history.gland_at_planning_mm = outcome.gland_at_planning_mm;
    history.gland_at_delivery_mm = outcome.gland_at_delivery_mm;
    for (std::size_t n = 0; n < groups[g].size(); ++n) {
      const std::size_t k = groups[g][n];
      NeedleOutcome& one = outcome.needles[n];
      Scenario::Seed choice = scenario.seed;
      choice.stranded = needles[k].stranded.value_or(choice.stranded);
      settle_seeds(one.seeds, choice, k);
      for (SeedHistory& seed : one.seeds) {
        seed.needle = k;
        history.seeds.push_back(seed);
      }
      history.needles[k] = std::move(one.needle);
      history.needles[k].record.group = g;
      warnings[k] = std::move(one.warnings);
    }
  }
  for (const auto& of_needle : warnings)
    history.warnings.insert(history.warnings.end(), of_needle.begin(), of_needle.end());
  std::sort(history.seeds.begin(), history.seeds.end(),
            [](const SeedHistory& a, const SeedHistory& b) { return a.number < b.number; });
  return history;
}

}  // namespace stylet
