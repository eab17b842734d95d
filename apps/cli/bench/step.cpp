// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/scale_bench.hpp"
#include "stylet/measure/step_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace stylet::cli {

namespace {

std::vector<std::string> phase_cells(const std::string& what, const measure::StepRow& row,
                                     const std::array<double, kStepPhases>& us) {
  std::vector<std::string> cells{std::to_string(row.contacts_max), what};
  const double all = std::accumulate(us.begin(), us.end(), 0.0);
  cells.push_back(number(all, 1));
  for (const double phase : us) cells.push_back(number(100.0 * phase / all, 1));
  return cells;
}

Json phases_json(const std::array<double, kStepPhases>& us) {
  Json json;
  for (int p = 0; p < kStepPhases; ++p) json[to_string(static_cast<StepPhase>(p))] = us[static_cast<std::size_t>(p)];
  return json;
}

}  // namespace

Result<> bench_scale_command(const BenchArguments& arguments, Console& console) {
  measure::ScaleBenchOptions options;
  if (arguments.nodes > 0) options.largest = arguments.nodes;
  if (auto checked =
          check_nodes("scale", options.largest, 570, "Use 570 nodes or more; this is the mesh of Goksel et al. 2005");
      !checked)
    return checked;
  if (arguments.contacts > 0) options.contacts = {arguments.contacts};
  options.steps = arguments.steps;
  const auto rows = measure::bench_scale(options, console.progress());
  if (!rows) return rows.error();
  Table table({"nodes",
               "element",
               "contacts",
               "steps",
               "events",
               "flagged",
               "iterations",
               "p50 [µs]",
               "p99 [µs]",
               "p99.9 [µs]",
               "max [µs]",
               "p99 / 570",
               "wall p99 [µs]",
               "all steps",
               "longest [µs]",
               "over 1 ms",
               "their medians [µs]",
               "fixed work",
               "by medians [µs]",
               "mesh [s]",
               "factor [s]",
               "store [s]",
               "memory [MB]"});
  Json json{{"rows", Json::array()}};
  for (const measure::ScaleRow& row : *rows) {
    const auto coarsest = std::find_if(rows->begin(), rows->end(),
                                       [&](const measure::ScaleRow& r) { return r.contacts == row.contacts; });
    const double ratio = row.cpu_us.p99 / coarsest->cpu_us.p99;
    table.row({std::to_string(row.nodes),
               row.element,
               std::to_string(row.contacts_max),
               std::to_string(row.steps),
               std::to_string(row.events),
               std::to_string(row.flagged),
               number(row.iterations, 2),
               number(row.cpu_us.p50, 0),
               number(row.cpu_us.p99, 0),
               number(row.cpu_us.p999, 0),
               number(row.cpu_us.max, 0),
               number(ratio, 2),
               number(row.wall_us.p99, 0),
               std::to_string(row.all_steps),
               number(row.all_longest_us, 0),
               std::to_string(row.all_over_1ms),
               number(row.over_1ms_median_us, 0),
               std::to_string(row.fixed_over_1ms),
               number(row.all_longest_median_us, 0),
               number(row.mesh_s, 1),
               number(row.factor_s, 1),
               number(row.store_s, 1),
               number(row.memory_mb, 0)});
    json["rows"].push_back({{"nodes", row.nodes},
                            {"element", row.element},
                            {"contacts", row.contacts},
                            {"contacts_max", row.contacts_max},
                            {"spacing_mm", row.spacing_mm},
                            {"steps", row.steps},
                            {"events", row.events},
                            {"flagged", row.flagged},
                            {"iterations", row.iterations},
                            {"step_cpu_us", times_json(row.cpu_us)},
                            {"step_wall_us", times_json(row.wall_us)},
                            {"step_cpu_p99_over_coarsest", ratio},
                            {"all_steps", row.all_steps},
                            {"all_longest_us", row.all_longest_us},
                            {"all_over_1ms", row.all_over_1ms},
                            {"all_cpu_s", row.all_cpu_s},
                            {"fixed_work_over_1ms", row.fixed_over_1ms},
                            {"fixed_work_cpu_s", row.fixed_cpu_s},
                            {"over_1ms_median_us", or_null(row.over_1ms_median_us)},
                            {"all_longest_median_us", or_null(row.all_longest_median_us)},
                            {"offline_s", {{"mesh", row.mesh_s}, {"factor", row.factor_s}, {"store", row.store_s}}},
                            {"memory_mb", row.memory_mb}});
  }
  json["machine"] = machine_json();
  console.say(
      "The demo's needle goes 90 mm into firm tissue, back and forth three times, and out. Times are thread CPU "
      "times.\n"
      "p50 … max: steps with nearly all contacts; p99 / 570: p99 divided by the p99 of the coarsest mesh with as many "
      "contacts;\n"
      "all steps, longest, over 1 ms: steps with any number of contacts; their medians: the longest of the steps over "
      "1 ms\n"
      "if each counts with the median of its repeats (--steps), which do the same work; fixed work: how often a fixed "
      "amount\n"
      "of arithmetic (about 100 µs), done after each step, took over 1 ms; by medians: the longest of all steps by "
      "medians.\n"
      "Before the first step: mesh from contours, factor of the stiffness, store of compliances and all other "
      "preparation;\n"
      "memory: resident memory before the first step.");
  console.say(table.text());
  return console.write_json(json);
}

Result<> bench_step_command(const BenchArguments& arguments, Console& console) {
  measure::StepBenchOptions options;
  if (arguments.nodes > 0) options.nodes = arguments.nodes;
  if (auto checked = check_nodes("step", options.nodes, 500,
                                 "Use 500 nodes or more; this is the coarsest mesh of the demo patient");
      !checked)
    return checked;
  const auto rows = measure::bench_step(options, console.progress());
  if (!rows) return rows.error();
  Table times({"nodes", "contacts", "steps", "iterations", "mean [µs]", "p50 [µs]", "p99 [µs]", "p99.9 [µs]",
               "max [µs]", "clock [%]"});
  std::vector<std::string> header{"contacts", "steps", "[µs]"};
  for (int p = 0; p < kStepPhases; ++p) header.emplace_back(std::string(to_string(static_cast<StepPhase>(p))) + " [%]");
  Table phases(header);
  Json json{{"rows", Json::array()}};
  for (const measure::StepRow& row : *rows) {
    times.row({std::to_string(row.nodes), std::to_string(row.contacts_max), std::to_string(row.steps),
               number(row.iterations, 2), number(row.mean_us, 0), number(row.cpu_us.p50, 0), number(row.cpu_us.p99, 0),
               number(row.cpu_us.p999, 0), number(row.cpu_us.max, 0), number(100.0 * row.clock_share, 1)});
    phases.row(phase_cells("all", row, row.phase_us));
    phases.row(phase_cells("slowest 1 %", row, row.slow_phase_us));
    json["rows"].push_back({{"nodes", row.nodes},
                            {"contacts", row.contacts},
                            {"contacts_max", row.contacts_max},
                            {"steps", row.steps},
                            {"iterations", row.iterations},
                            {"step_cpu_us", times_json(row.cpu_us)},
                            {"step_cpu_mean_us", row.mean_us},
                            {"phase_us", phases_json(row.phase_us)},
                            {"slow_phase_us", phases_json(row.slow_phase_us)},
                            {"clock_share", row.clock_share}});
  }
  json["machine"] = machine_json();
  console.say(
      "The insertion of `bench scale`: processor time of the steps with nearly all contacts. clock: increase of this "
      "time by reading\n"
      "the clock in every phase; each step counts with its shortest time in four runs with the clock and in four "
      "without.");
  console.say(times.text());
  console.say("Share of the time in each phase, in all steps and in the slowest 1 % of the steps:");
  console.say(phases.text());
  return console.write_json(json);
}

}  // namespace stylet::cli
