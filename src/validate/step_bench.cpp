// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/validate/step_bench.hpp"

#include "driven_needle.hpp"
#include "stylet/validate/context.hpp"

#include <algorithm>
#include <numeric>

namespace stylet::validate {

namespace {

constexpr double kSlow = 0.01;  ///< share of steps that count as the slowest

using Phases = std::array<double, kStepPhases>;

Phases mean_phases(const std::vector<DrivenStep>& steps, std::span<const std::size_t> chosen) {
  Phases mean{};
  for (const std::size_t k : chosen) {
    for (std::size_t p = 0; p < mean.size(); ++p) mean[p] += steps[k].phase_us[p] / static_cast<double>(chosen.size());
  }
  return mean;
}

double sum(const Phases& phases) { return std::accumulate(phases.begin(), phases.end(), 0.0); }

Result<StepRow> measure(const TetMesh& mesh, int contacts, const Progress& progress) {
  const auto model = Model::compile(driven_scenario(contacts), mesh, "the demo", {}, progress);
  if (!model) return model.error();
  const std::vector<DrivenStep> plain = drive_needle(*model, false, 0, progress);
  // The phases' clock is the wall's: of two runs the one that nothing else came between, step by step.
  std::vector<DrivenStep> phased = drive_needle(*model, true, 0, progress);
  const std::vector<DrivenStep> again = drive_needle(*model, true, 0, progress);
  for (std::size_t k = 0; k < phased.size(); ++k) {
    if (sum(again[k].phase_us) < sum(phased[k].phase_us)) phased[k] = again[k];
  }

  StepRow row;
  row.nodes = (*model)->mesh().node_count();
  row.contacts = contacts;
  std::vector<std::size_t> full = full_steps(plain);
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
  row.clock_share = sum(row.phase_us) / row.mean_us - 1.0;
  // The slowest of both runs: slow for what they do, not for what else the machine did.
  std::sort(full.begin(), full.end(), [&](std::size_t a, std::size_t b) {
    return std::min(plain[a].cpu_us, sum(phased[a].phase_us)) > std::min(plain[b].cpu_us, sum(phased[b].phase_us));
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

}  // namespace stylet::validate
