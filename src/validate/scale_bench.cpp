// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/validate/scale_bench.hpp"

#include "driven_needle.hpp"
#include "stylet/reproduce/measure.hpp"
#include "stylet/validate/context.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace stylet::validate {

namespace {

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0.0;
  double resident = 0.0;
  statm >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

/// Each step by the median of its repeats; the longest of them.
double longest_median(const std::vector<DrivenStep>& steps) {
  long places = 0;
  for (const DrivenStep& step : steps) places = std::max(places, step.place + 1);
  std::vector<std::vector<double>> repeats(static_cast<std::size_t>(places));
  for (const DrivenStep& step : steps) repeats[static_cast<std::size_t>(step.place)].push_back(step.cpu_us);
  double longest = std::numeric_limits<double>::quiet_NaN();
  for (std::vector<double>& us : repeats) {
    constexpr std::size_t enough = 3;
    if (us.size() < enough) return std::numeric_limits<double>::quiet_NaN();
    longest = std::fmax(longest, quantiles(std::move(us)).p50);
  }
  return longest;
}

constexpr double kFixedWork_us = 100.0;  ///< as a step with 40 contacts takes

Result<ScaleRow> measure(const MeshedAnatomy& anatomy, int contacts, long least, const FixedWork& fixed,
                         const Progress& progress) {
  ScaleRow row;
  row.contacts = contacts;
  const Scenario scenario = driven_scenario(contacts);
  row.spacing_mm = scenario.coupling.spacing_mm;
  const double start = reproduce::wall_s();
  const auto model = Model::compile(scenario, anatomy.mesh, "the demo", {}, progress);
  if (!model) return model.error();
  row.nodes = (*model)->mesh().node_count();
  row.element = to_string((*model)->tissue().element());
  row.mesh_s = anatomy.report.seconds;
  row.factor_s = (*model)->tissue().statistics().factor_seconds;
  row.store_s = reproduce::wall_s() - start - row.factor_s;
  row.memory_mb = resident_mb();

  const std::vector<DrivenStep> steps = drive_needle(*model, false, least, progress, &fixed);
  row.all_steps = static_cast<long>(steps.size());
  for (const DrivenStep& step : steps) {
    row.all_longest_us = std::max(row.all_longest_us, step.cpu_us);
    row.all_cpu_s += 1e-6 * step.cpu_us;
    row.fixed_cpu_s += 1e-6 * step.fixed_us;
    if (step.cpu_us > 1000.0) ++row.all_over_1ms;
    if (step.fixed_us > 1000.0) ++row.fixed_over_1ms;
  }
  row.all_longest_median_us = longest_median(steps);
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

}  // namespace stylet::validate
