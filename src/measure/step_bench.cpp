// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/step_bench.hpp"

#include "driven_needle.hpp"
#include "stylet/measure/demo.hpp"

#include <algorithm>
#include <numeric>

namespace stylet::measure {

namespace {

constexpr double kSlow = 0.01;  ///< share of the steps that count as the slowest
constexpr int kRuns = 4;        ///< number of runs with timed phases, and number of runs without

using Phases = std::array<double, kStepPhases>;

Phases mean_phases(const std::vector<DrivenStep>& steps, std::span<const std::size_t> chosen) {
  Phases mean{};
  for (const std::size_t k : chosen) {
    for (std::size_t p = 0; p < mean.size(); ++p) mean[p] += steps[k].phase_us[p] / static_cast<double>(chosen.size());
  }
  return mean;
}

std::vector<double> cpu_us_of(const std::vector<DrivenStep>& steps) {
  std::vector<double> us(steps.size());
  std::transform(steps.begin(), steps.end(), us.begin(), [](const DrivenStep& step) { return step.cpu_us; });
  return us;
}

void keep_shorter(std::vector<double>& us, const std::vector<double>& others) {
  for (std::size_t k = 0; k < us.size(); ++k) us[k] = std::min(us[k], others[k]);
}

double sum_of(const std::vector<double>& us, std::span<const std::size_t> chosen) {
  return std::accumulate(chosen.begin(), chosen.end(), 0.0, [&](double all, std::size_t k) { return all + us[k]; });
}

double sum(const Phases& phases) { return std::accumulate(phases.begin(), phases.end(), 0.0); }

Result<StepRow> measure(const TetMesh& mesh, int contacts, const Progress& progress) {
  const auto model = Model::compile(driven_scenario(contacts), mesh, "the demo", {}, progress);
  if (!model) return model.error();
  // The two kinds of runs alternate, so that a machine that becomes slower affects both. Of each kind the shortest time
  // of a step is kept, which has the fewest interruptions.
  const std::vector<DrivenStep> plain = drive_needle(*model, false, 0, progress);
  std::vector<DrivenStep> phased = drive_needle(*model, true, 0, progress);
  std::vector<double> plain_us = cpu_us_of(plain), phased_us = cpu_us_of(phased);
  for (int run = 1; run < kRuns; ++run) {
    keep_shorter(plain_us, cpu_us_of(drive_needle(*model, false, 0, progress)));
    const std::vector<DrivenStep> again = drive_needle(*model, true, 0, progress);
    keep_shorter(phased_us, cpu_us_of(again));
    for (std::size_t k = 0; k < phased.size(); ++k) {
      if (sum(again[k].phase_us) < sum(phased[k].phase_us)) phased[k] = again[k];
    }
  }

  StepRow row;
  std::vector<std::size_t> full = full_steps(plain);
  row.nodes = (*model)->mesh().node_count();
  row.contacts = contacts;
  std::vector<double> cpu;
  for (const std::size_t k : full) {
    cpu.push_back(plain[k].cpu_us);
    row.mean_us += plain[k].cpu_us / static_cast<double>(full.size());
    row.iterations += plain[k].iterations / static_cast<double>(full.size());
    row.contacts_max = std::max(row.contacts_max, plain[k].contacts);
  }
  row.steps = static_cast<long>(full.size());
  row.cpu_us = quantiles(std::move(cpu));
  row.phase_us = mean_phases(phased, full);
  row.clock_share = sum_of(phased_us, full) / sum_of(plain_us, full) - 1.0;
  // The slowest steps are those that are slow in both kinds of runs, so that interruptions do not count.
  std::sort(full.begin(), full.end(), [&](std::size_t a, std::size_t b) {
    return std::min(plain_us[a], sum(phased[a].phase_us)) > std::min(plain_us[b], sum(phased[b].phase_us));
  });
  full.resize(std::max<std::size_t>(1, static_cast<std::size_t>(kSlow * static_cast<double>(full.size()))));
  row.slow_phase_us = mean_phases(phased, full);
  return row;
}

}  // namespace

Result<std::vector<StepRow>> bench_step(const StepBenchOptions& options, const Progress& progress) {
  const auto anatomy = mesh_demo(options.nodes, progress);
  if (!anatomy) return anatomy.error();
  std::vector<StepRow> rows;
  for (const int contacts : {20, 40, 60}) {
    auto row = measure(anatomy->mesh, contacts, progress);
    if (!row) return row.error();
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace stylet::measure
