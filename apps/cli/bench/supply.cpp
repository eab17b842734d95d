// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/supply_bench.hpp"

#include <fmt/format.h>

namespace stylet::cli {

Result<> bench_supply_command(const BenchArguments& arguments, Console& console) {
  measure::SupplyBenchOptions options;
  if (arguments.nodes > 0) options.largest = arguments.nodes;
  if (arguments.speed > 0.0) options.speeds_mm_per_s = {arguments.speed};
  if (auto checked = check_nodes("supply", options.largest, 570,
                                 "Use 570 nodes or more; this is the coarsest mesh of the demo patient");
      !checked)
    return checked;
  const auto rows = measure::bench_supply(options, console.progress());
  if (!rows) return rows.error();
  Table table({"nodes", "element", "prepared", "speed [mm/s]", "steps", "outrun [%]", "force off [N]", "peak [N]",
               "rows", "rows / s", "longest step [µs]"});
  Json json{{"rows", Json::array()}};
  for (const measure::SupplyRow& row : *rows) {
    const double outrun = static_cast<double>(row.flagged) / std::max(1.0, static_cast<double>(row.steps));
    table.row({std::to_string(row.nodes), row.element, std::to_string(row.prepared), number(row.speed_mm_per_s, 0),
               std::to_string(row.steps), number(100.0 * outrun, 1), number(row.force_off_N, 3),
               number(row.force_peak_N, 2), std::to_string(row.rows), number(row.rows_per_s, 0),
               number(row.longest_cpu_us, 0)});
    json["rows"].push_back({{"nodes", row.nodes},
                            {"element", row.element},
                            {"prepared_nodes", row.prepared},
                            {"speed_mm_per_s", row.speed_mm_per_s},
                            {"steps", row.steps},
                            {"flagged", row.flagged},
                            {"force_off_N", row.force_off_N},
                            {"force_peak_N", row.force_peak_N},
                            {"rows", row.rows},
                            {"rows_per_s", row.rows_per_s},
                            {"longest_step_cpu_us", row.longest_cpu_us}});
  }
  json["machine"] = machine_json();
  console.say(
      "The demo's needle is inserted beside its planned way, where no compliance was prepared, in 1 kHz real time; a\n"
      "worker thread computes the compliance. outrun: steps in which compliance was missing; force off: largest\n"
      "difference of the axial force from a run with all compliance; peak: largest axial force of that run; rows: "
      "nodes\n"
      "whose compliance the worker computed; longest step: processor time.");
  console.say(table.text());
  return console.write_json(json);
}

}  // namespace stylet::cli
