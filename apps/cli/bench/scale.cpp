// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/scale_bench.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::cli {

Result<> bench_scale_command(const BenchArguments& arguments, Console& console) {
  measure::ScaleBenchOptions options;
  if (arguments.nodes > 0) options.largest = arguments.nodes;
  need(check_nodes("scale", options.largest, 570, "Give 570 or more, the nodes of the mesh of Goksel et al. 2005"));
  if (arguments.contacts > 0) options.contacts = {arguments.contacts};
  options.steps = arguments.steps;
  const auto rows = need(measure::bench_scale(options, console.progress()));
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
  for (const measure::ScaleRow& row : rows) {
    const auto coarsest =
        std::find_if(rows.begin(), rows.end(), [&](const measure::ScaleRow& r) { return r.contacts == row.contacts; });
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
  need(console.print(
      "The needle of the demo scenario in firm tissue: 90 mm in, back and forth three times, and out. The times are of "
      "the steps that have nearly all contacts.\n"
      "p50 … max: processor time of the thread. p99 / 570: ratio of p99 to p99 on the coarsest mesh with as many "
      "contacts.\n"
      "All steps, longest, over 1 ms: processor times of all steps, with any number of contacts.\n"
      "Their medians: the longest of the steps over 1 ms after each time was replaced by the median over the repeats "
      "of that step (--steps), which do the same work.\n"
      "Fixed work: after each step a fixed calculation of about 100 µs is timed; this column counts how often it took "
      "over 1 ms.\n"
      "By medians: the longest of all steps after each time was replaced by the median over the repeats of that step.\n"
      "Mesh, factor, store: time before the first step, for meshing the contours, factorising the stiffness, and "
      "computing the stored compliances with everything else. Memory: resident memory after that."));
  need(console.print(table.text()));
  return console.write_json(json);
}

}  // namespace stylet::cli
