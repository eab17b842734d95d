// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/display_bench.hpp"

#include <fmt/format.h>

namespace stylet::cli {

Result<> bench_display_command(const BenchArguments& arguments, Console& console) {
  measure::DisplayBenchOptions options;
  if (arguments.nodes > 0) options.largest = arguments.nodes;
  if (auto checked = check_nodes("display", options.largest, 570,
                                 "Use 570 nodes or more; this is the coarsest mesh that is measured");
      !checked)
    return checked;
  const auto rows = measure::bench_display(options, console.progress());
  if (!rows) return rows.error();
  Table table({"nodes",      "surface",    "triangles",  "zone",        "columns",     "surface [ms]", "max",
               "slice [ms]", "max",        "both [ms]",  "max",         "fine",        "near [ms]",    "max",
               "solve [ms]", "moved [mm]", "error [mm]", "stated [mm]", "coarse [mm]", "prepare [s]",  "memory [MB]"});
  Json json{{"rows", Json::array()}};
  for (const measure::DisplayRow& row : *rows) {
    table.row({std::to_string(row.nodes),
               std::to_string(row.surface_nodes),
               std::to_string(row.slice_triangles),
               std::to_string(row.zone_dofs),
               std::to_string(row.columns),
               number(1e-3 * row.surface_us.p50, 2),
               number(1e-3 * row.surface_us.max, 2),
               number(1e-3 * row.slice_us.p50, 2),
               number(1e-3 * row.slice_us.max, 2),
               number(1e-3 * row.both_us.p50, 2),
               number(1e-3 * row.both_us.max, 2),
               std::to_string(row.fine_points),
               number(1e-3 * row.near_us.p50, 2),
               number(1e-3 * row.near_us.max, 2),
               number(1e-3 * row.solve_us, 1),
               number(row.largest_mm, 2),
               fmt::format("{:.1e}", row.error_mm),
               fmt::format("{:.1e}", row.stated_error_mm),
               number(row.coarse_error_mm, 2),
               number(row.prepare_s, 1),
               number(row.megabytes, 0)});
    json["rows"].push_back({{"nodes", row.nodes},
                            {"element", row.element},
                            {"surface_nodes", row.surface_nodes},
                            {"slice_triangles", row.slice_triangles},
                            {"zone_dofs", row.zone_dofs},
                            {"columns", row.columns},
                            {"frames", row.frames},
                            {"surface_us", times_json(row.surface_us)},
                            {"slice_us", times_json(row.slice_us)},
                            {"both_us", times_json(row.both_us)},
                            {"fine_points", row.fine_points},
                            {"near_us", times_json(row.near_us)},
                            {"solve_us", row.solve_us},
                            {"largest_mm", row.largest_mm},
                            {"error_mm", row.error_mm},
                            {"stated_error_mm", row.stated_error_mm},
                            {"stated_error_mm_per_N", row.stated_error_mm_per_N},
                            {"left_out_N", row.left_out_N},
                            {"coarse_error_mm", or_null(row.coarse_error_mm)},
                            {"prepare_s", row.prepare_s},
                            {"memory_mb", row.megabytes}});
  }
  json["machine"] = machine_json();
  console.say(
      "Pictures of the deformed patient during an insertion. Processor times, median and largest, of all surfaces, of "
      "a "
      "slice, and of both;\n"
      "fine: points of the surfaces after refinement along the needle's way; near: time of the needle's near field at "
      "these points;\n"
      "solve: time of a picture computed by a solve with the factor of the stiffness; moved: largest displacement; "
      "error: largest\n"
      "difference of a node from that solve; stated: the error bound stated for these forces; coarse: the error if the "
      "displacement\n"
      "of the coarsest mesh is shown instead.");
  console.say(table.text());
  return console.write_json(json);
}

}  // namespace stylet::cli
