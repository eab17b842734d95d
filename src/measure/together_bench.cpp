// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/together_bench.hpp"

#include "driven_needle.hpp"

#include "stylet/core/flush_denormals.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/sim/simulation.hpp"

#include <algorithm>
#include <array>

namespace stylet::measure {

namespace {

constexpr double kTimedFrom_mm = 40.0;
constexpr double kDepth_mm = 85.0;
/// Step [s] and speed [mm/s] of a needle whose steps are timed, and of one that is only put in.
constexpr double kTimedStep_s = 1e-3, kTimedSpeed_mm_per_s = 20.0;
constexpr double kQuickStep_s = 4e-3, kQuickSpeed_mm_per_s = 40.0;

/// Holes of the template from the middle of the gland outwards.
constexpr std::array<const char*, kMostAtRest + 1> kHoles{"D3",   "d3",   "D2.5", "d2.5", "C3",   "c3",   "E3",
                                                          "e3",   "C2.5", "c2.5", "D3.5", "d3.5", "E2.5", "e2.5",
                                                          "C3.5", "c3.5", "D2",   "d2",   "E3.5", "C2",   "c2"};

bool is_timed(int at_rest, int most) {
  constexpr std::array<int, 6> kTimed{0, 1, 2, 5, 10, 20};
  return at_rest == most || std::find(kTimed.begin(), kTimed.end(), at_rest) != kTimed.end();
}

/// Puts the needle that is held to its depth. @return the timed steps; none where it is only put in
TogetherRow put_in(Simulation& simulation, const PlannedInsertion& plan, bool timed) {
  TogetherRow row;
  std::vector<double> us;
  Pose base = plan.motion.at(0.0);
  simulation.place(base, plan.entry, plan.direction);
  const double dt = timed ? kTimedStep_s : kQuickStep_s;
  const double way = dt * (timed ? kTimedSpeed_mm_per_s : kQuickSpeed_mm_per_s);
  double iterations = 0.0;
  while (simulation.last_step().base_depth_mm < kDepth_mm) {
    base.origin += way * plan.direction;
    simulation.prepare();
    const double seconds = cpu_seconds([&] { simulation.step(base, dt); });
    const Step& step = simulation.last_step();
    if (!timed || step.base_depth_mm < kTimedFrom_mm) continue;
    us.push_back(1e6 * seconds);
    iterations += step.iterations;
    if ((step.flags & Step::not_converged) != 0) ++row.flagged;
  }
  row.steps = static_cast<long>(us.size());
  row.iterations = us.empty() ? 0.0 : iterations / static_cast<double>(us.size());
  row.contacts = simulation.last_step().contacts;
  row.cpu_us = quantiles(std::move(us));
  return row;
}

}  // namespace

Result<std::vector<TogetherRow>> bench_together(const TogetherBenchOptions& options, const Progress& progress) {
  Scenario scenario = demo_scenario();
  scenario.insertions.clear();
  for (int needle = 0; needle <= options.needles; ++needle) {
    InsertionPlan& plan = scenario.insertions.emplace_back();
    plan.hole = kHoles[static_cast<std::size_t>(needle)];
    plan.depth_mm = kDepth_mm;
  }
  const auto anatomy = mesh_demo(options.nodes, progress);
  if (!anatomy) return anatomy.error();
  const auto model = Model::compile(scenario, anatomy->mesh, "the demo", {}, progress);
  if (!model) return model.error();
  const FlushDenormals flush;
  Simulation simulation(*model, options.needles + 1);
  std::vector<TogetherRow> rows;
  int at_rest_contacts = 0;
  for (int at_rest = 0; at_rest <= options.needles; ++at_rest) {
    report(progress, "needles", at_rest / (options.needles + 1.0));
    if (Result<> taken = simulation.take_up(at_rest); !taken) return taken.error();
    const bool timed = is_timed(at_rest, options.needles);
    TogetherRow row = put_in(simulation, (*model)->insertions()[static_cast<std::size_t>(at_rest)], timed);
    row.at_rest = at_rest;
    row.contacts_in_all = at_rest_contacts + row.contacts;
    at_rest_contacts = row.contacts_in_all;
    if (timed) rows.push_back(row);
  }
  return rows;
}

}  // namespace stylet::measure
