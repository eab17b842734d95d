// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/validate/scale_bench.hpp"

#include "stylet/mesher/mesher.hpp"
#include "stylet/phantom/phantom.hpp"
#include "stylet/reproduce/measure.hpp"
#include "stylet/sim/simulation.hpp"
#include "stylet/validate/context.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>

namespace stylet::validate {

namespace {

constexpr double kDepth_mm = 90.0;
constexpr double kSpeed_mm_per_s = 20.0;
constexpr double kDt_s = 1e-3;
constexpr double kBackAndForth_mm = 15.0;
constexpr double kFurther_mm = 1.0;
constexpr int kCycles = 3;
/// Steps with fewer of the most contacts are not of that number.
constexpr double kShare = 0.85;

double wall_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0.0;
  double resident = 0.0;
  statm >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

StepTimes quantiles(std::vector<double> us) {
  if (us.empty()) return {};
  std::sort(us.begin(), us.end());
  const auto at = [&](double q) {
    return us[std::min(us.size() - 1, static_cast<std::size_t>(q * static_cast<double>(us.size())))];
  };
  return {at(0.5), at(0.99), at(0.999), us.back()};
}

/// Depth of the base at every step: in, back and forth, out.
std::vector<double> depths(double start_mm) {
  std::vector<double> turns{start_mm, kDepth_mm};
  for (int cycle = 1; cycle <= kCycles; ++cycle) {
    turns.push_back(turns.back() - kBackAndForth_mm);
    turns.push_back(kDepth_mm + cycle * kFurther_mm);
  }
  turns.push_back(start_mm);
  std::vector<double> result;
  for (std::size_t k = 1; k < turns.size(); ++k) {
    const double way = turns[k] - turns[k - 1];
    const auto steps = std::lround(std::abs(way) / (kSpeed_mm_per_s * kDt_s));
    for (long i = 1; i <= steps; ++i)
      result.push_back(turns[k - 1] + way * static_cast<double>(i) / static_cast<double>(steps));
  }
  return result;
}

struct Step {
  int contacts = 0;
  int iterations = 0;
  int events = 0;
  bool flagged = false;
  double cpu_us = 0.0;
  double wall_us = 0.0;
};

/// Once in, back and forth, and out.
void drive(Simulation& simulation, std::vector<Step>& steps) {
  const PlannedInsertion& plan = simulation.model().insertions().front();
  const Pose first = plan.motion.at(0.0);
  simulation.place(first, plan.entry, plan.direction);
  const double start = simulation.record().base_depth_mm;
  const std::vector<double> way = depths(start);
  steps.reserve(steps.size() + way.size());
  for (const double depth : way) {
    Pose base = first;
    base.origin += (depth - start) * plan.direction;
    simulation.prepare();
    const double wall = wall_s();
    const double cpu = reproduce::thread_cpu_s();
    simulation.step(base, kDt_s);
    const double cpu_after = reproduce::thread_cpu_s();
    const double wall_after = wall_s();
    steps.push_back({simulation.record().contacts, simulation.record().iterations,
                     static_cast<int>(simulation.new_events().size()), simulation.report().flags != 0,
                     1e6 * (cpu_after - cpu), 1e6 * (wall_after - wall)});
  }
}

std::vector<Step> drive(const std::shared_ptr<const Model>& model, long least, const Progress& progress) {
  std::vector<Step> steps;
  auto simulation = std::make_unique<Simulation>(model);
  for (int times = 0; times == 0 || static_cast<long>(steps.size()) < least; ++times) {
    report(progress, "stepping", static_cast<double>(steps.size()) / static_cast<double>(std::max(1L, least)));
    if (times > 0 && times % 2 == 0) simulation = std::make_unique<Simulation>(model);
    drive(*simulation, steps);
  }
  return steps;
}

Result<ScaleRow> measure(const MeshedAnatomy& anatomy, int contacts, long least, const Progress& progress) {
  ScaleRow row;
  row.contacts = contacts;
  row.spacing_mm = (kDepth_mm + kCycles * kFurther_mm) / (contacts - 1);  // the tip is one of them
  Scenario scenario = demo_scenario();
  scenario.coupling.spacing_mm = row.spacing_mm;
  scenario.coupling.contacts = std::max(scenario.coupling.contacts, contacts + 20);
  scenario.insertions.front().depth_mm = kDepth_mm + kCycles * kFurther_mm;
  scenario.output.frames_per_s = 0.0;
  const double start = wall_s();
  const auto model = Model::compile(scenario, anatomy.mesh, "the demo", {}, progress);
  if (!model) return model.error();
  row.nodes = (*model)->mesh().node_count();
  row.element = to_string((*model)->tissue().element());
  row.mesh_s = anatomy.report.seconds;
  row.factor_s = (*model)->tissue().statistics().factor_seconds;
  row.store_s = wall_s() - start - row.factor_s;
  row.memory_mb = resident_mb();

  const std::vector<Step> steps = drive(*model, least, progress);
  row.all_steps = static_cast<long>(steps.size());
  for (const Step& step : steps) row.contacts_max = std::max(row.contacts_max, step.contacts);
  std::vector<double> cpu;
  std::vector<double> wall;
  for (const Step& step : steps) {
    row.all_longest_us = std::max(row.all_longest_us, step.cpu_us);
    if (step.cpu_us > 1000.0) ++row.all_over_1ms;
    if (step.contacts < kShare * row.contacts_max) continue;
    cpu.push_back(step.cpu_us);
    wall.push_back(step.wall_us);
    row.events += step.events;
    row.flagged += step.flagged ? 1 : 0;
    row.iterations += step.iterations;
  }
  row.steps = static_cast<long>(cpu.size());
  row.iterations /= std::max(1.0, static_cast<double>(row.steps));
  row.cpu_us = quantiles(std::move(cpu));
  row.wall_us = quantiles(std::move(wall));
  return row;
}

}  // namespace

Result<std::vector<ScaleRow>> bench_scale(const ScaleBenchOptions& options, const Progress& progress) {
  const ContourSet patient = demo_patient();
  std::vector<ScaleRow> rows;
  for (const Index nodes : {570, 5000, 20000, 100000}) {
    if (nodes > options.largest) continue;
    MeshOptions mesh;
    mesh.nodes = nodes;
    mesh.cull_tolerance_mm = demo_scenario().mesh.cull_mm;
    const auto anatomy = mesh_contours(patient, mesh, progress);
    if (!anatomy) return anatomy.error();
    for (const int contacts : options.contacts) {
      auto row = measure(*anatomy, contacts, options.steps, progress);
      if (!row) return row.error();
      rows.push_back(std::move(*row));
    }
  }
  return rows;
}

}  // namespace stylet::validate
