// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/scale_bench.hpp"

#include "driven_needle.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/measure/timing.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace stylet::measure {

namespace {

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0.0;
  double resident = 0.0;
  statm >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

/// The median time of the repeats of each step, by DrivenStep::place; NaN with fewer than three repeats.
std::vector<double> medians_of_repeats(const std::vector<DrivenStep>& steps) {
  std::vector<std::vector<double>> repeats;
  for (const DrivenStep& step : steps) {
    const auto place = static_cast<std::size_t>(step.place);
    if (place >= repeats.size()) repeats.resize(place + 1);
    repeats[place].push_back(step.cpu_us);
  }
  constexpr std::size_t enough = 3;
  std::vector<double> medians;
  medians.reserve(repeats.size());
  for (std::vector<double>& us : repeats) {
    medians.push_back(us.size() < enough ? std::numeric_limits<double>::quiet_NaN() : quantiles(std::move(us)).p50);
  }
  return medians;
}

/// The largest value; NaN if one of them is NaN or there are none.
double longest(const std::vector<double>& us) {
  double most = -std::numeric_limits<double>::infinity();
  for (const double one : us) most = std::isnan(one) || one > most ? one : most;
  return us.empty() ? std::numeric_limits<double>::quiet_NaN() : most;
}

constexpr double kDeadline_us = 1000.0;
constexpr double kFixedWork_us = 100.0;  ///< about the time of a step with 40 contacts

Result<ScaleRow> measure(const MeshedAnatomy& anatomy, int contacts, long least, const FixedWork& fixed,
                         const Progress& progress) {
  ScaleRow row;
  row.contacts = contacts;
  const Scenario scenario = driven_scenario(contacts);
  row.spacing_mm = scenario.coupling.spacing_mm;
  const double start = measure::wall_s();
  const auto model = Model::compile(scenario, anatomy.mesh, "the demo", {}, progress);
  if (!model) return model.error();
  row.nodes = (*model)->mesh().node_count();
  row.element = to_string((*model)->tissue().element());
  row.mesh_s = anatomy.report.seconds;
  row.factor_s = (*model)->tissue().statistics().factor_seconds;
  row.store_s = measure::wall_s() - start - row.factor_s;
  row.memory_mb = resident_mb();

  const std::vector<DrivenStep> steps = drive_needle(*model, least, progress, &fixed);
  const std::vector<double> medians = medians_of_repeats(steps);
  std::vector<double> over;
  row.all_steps = static_cast<long>(steps.size());
  for (const DrivenStep& step : steps) {
    row.all_longest_us = std::max(row.all_longest_us, step.cpu_us);
    row.all_cpu_s += 1e-6 * step.cpu_us;
    row.fixed_cpu_s += 1e-6 * step.fixed_us;
    if (step.cpu_us > kDeadline_us) over.push_back(medians[static_cast<std::size_t>(step.place)]);
    if (step.fixed_us > kDeadline_us) ++row.fixed_over_1ms;
  }
  row.all_over_1ms = static_cast<long>(over.size());
  row.over_1ms_median_us = longest(over);
  row.all_longest_median_us = longest(medians);
  std::vector<double> cpu;
  std::vector<double> wall;
  for (const std::size_t k : full_steps(steps)) {
    const DrivenStep& step = steps[k];
    row.contacts_max = std::max(row.contacts_max, step.contacts);
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
  std::vector<ScaleRow> rows;
  const FixedWork fixed(kFixedWork_us);
  for (const Index nodes : {570, 5000, 20000, 100000}) {
    if (nodes > options.largest) continue;
    const auto anatomy = mesh_demo(nodes, progress);
    if (!anatomy) return anatomy.error();
    for (const int contacts : options.contacts) {
      auto row = measure(*anatomy, contacts, options.steps, fixed, progress);
      if (!row) return row.error();
      rows.push_back(std::move(*row));
    }
  }
  return rows;
}

}  // namespace stylet::measure
