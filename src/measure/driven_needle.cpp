// SPDX-License-Identifier: GPL-3.0-or-later
#include "driven_needle.hpp"

#include "stylet/measure/demo.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/sim/simulation.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::measure {

namespace {

constexpr double kDrivenDepth_mm = 90.0;
constexpr double kDrivenSpeed_mm_per_s = 20.0;
constexpr double kBackAndForth_mm = 15.0;
constexpr double kFurther_mm = 1.0;
constexpr int kCycles = 3;
constexpr double kDeepest_mm = kDrivenDepth_mm + kCycles * kFurther_mm;
/// Steps with less than this share of the largest number of contacts do not count as full.
constexpr double kShare = 0.85;

/// Simulates one insertion: in, back and forth, and out.
/// @param place DrivenStep::place of the first step
void drive(Simulation& simulation, long least, long place, std::vector<DrivenStep>& steps, const Progress& progress,
           const FixedWork* fixed) {
  const PlannedInsertion& plan = simulation.model().insertions().front();
  const Pose first = plan.motion.at(0.0);
  simulation.place(first, plan.entry, plan.direction);
  const double start = simulation.last_step().base_depth_mm;
  const std::vector<double> way = driven_depths(start);
  const double wanted = static_cast<double>(std::max(least, static_cast<long>(way.size())));
  if (steps.empty()) {
    // Touches the memory of all steps beforehand. Memory that is moved or first written between steps makes work for
    // the system, which would lengthen later steps.
    steps.resize(static_cast<std::size_t>(least) + way.size());
    steps.clear();
  }
  for (const double depth : way) {
    Pose base = first;
    base.origin += (depth - start) * plan.direction;
    simulation.prepare();
    DrivenStep step;
    step.place = place++;
    const double wall = measure::wall_s();
    const double cpu = measure::thread_cpu_s();
    simulation.step(base, kDrivenStep_s);
    step.cpu_us = 1e6 * (measure::thread_cpu_s() - cpu);
    step.wall_us = 1e6 * (measure::wall_s() - wall);
    if (fixed != nullptr) step.fixed_us = fixed->run();
    step.contacts = simulation.last_step().contacts;
    step.iterations = simulation.last_step().iterations;
    step.events = static_cast<int>(simulation.new_events().size());
    step.flagged = simulation.last_step().flags != 0;
    steps.push_back(step);
    if (steps.size() % 512 == 0) report(progress, "stepping", static_cast<double>(steps.size()) / wanted);
  }
}

}  // namespace

std::vector<double> driven_depths(double start_mm) {
  std::vector<double> turns{start_mm, kDrivenDepth_mm};
  for (int cycle = 1; cycle <= kCycles; ++cycle) {
    turns.push_back(turns.back() - kBackAndForth_mm);
    turns.push_back(kDrivenDepth_mm + cycle * kFurther_mm);
  }
  turns.push_back(start_mm);
  std::vector<double> result;
  for (std::size_t k = 1; k < turns.size(); ++k) {
    const double way = turns[k] - turns[k - 1];
    const auto steps = std::lround(std::abs(way) / (kDrivenSpeed_mm_per_s * kDrivenStep_s));
    for (long i = 1; i <= steps; ++i)
      result.push_back(turns[k - 1] + way * static_cast<double>(i) / static_cast<double>(steps));
  }
  return result;
}

int most_driven_contacts() { return 1 + static_cast<int>(kDeepest_mm / demo_scenario().needle.diameter_mm); }

Scenario driven_scenario(int contacts) {
  Scenario scenario = demo_scenario();
  scenario.tissue_model.preset = TissuePreset::firm;
  scenario.coupling.spacing_mm = kDeepest_mm / (contacts - 1);  // the tip is a contact too
  scenario.coupling.contacts = std::max(scenario.coupling.contacts, contacts + 20);
  scenario.insertions.front().depth_mm = kDeepest_mm;
  scenario.output.frames_per_s = 0.0;
  return scenario;
}

std::vector<DrivenStep> drive_needle(const std::shared_ptr<const Model>& model, long least, const Progress& progress,
                                     const FixedWork* fixed) {
  std::vector<DrivenStep> steps;
  std::unique_ptr<Simulation> simulation;
  for (int times = 0; times == 0 || static_cast<long>(steps.size()) < least; ++times) {
    const bool fresh = times % 2 == 0;
    if (fresh) simulation = std::make_unique<Simulation>(model);
    drive(*simulation, least, fresh ? 0 : steps.back().place + 1, steps, progress, fixed);
  }
  return steps;
}

std::vector<std::size_t> full_steps(const std::vector<DrivenStep>& steps) {
  int most = 0;
  for (const DrivenStep& step : steps) most = std::max(most, step.contacts);
  std::vector<std::size_t> full;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (steps[k].contacts >= kShare * most) full.push_back(k);
  }
  return full;
}

StepTimes quantiles(std::vector<double> us) {
  if (us.empty()) return {};
  std::sort(us.begin(), us.end());
  const auto at = [&](double q) {
    return us[std::min(us.size() - 1, static_cast<std::size_t>(q * static_cast<double>(us.size())))];
  };
  return {at(0.5), at(0.99), at(0.999), us.back()};
}

}  // namespace stylet::measure
