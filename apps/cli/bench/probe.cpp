// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/probe_bench.hpp"

namespace stylet::cli {

Result<> bench_probe_command(const BenchArguments& arguments, Console& console) {
  measure::ProbeBenchOptions options;
  if (arguments.nodes > 0) options.largest = arguments.nodes;
  if (auto checked = check_nodes("probe", options.largest, 3000,
                                 "Give 3000 or more, the nodes of the coarsest mesh of this benchmark");
      !checked)
    return checked;
  const auto rows = measure::bench_probe(options, console.progress());
  if (!rows) return rows.error();
  Table table({"nodes", "areas", "poses", "pose [ms]", "99 % [ms]", "worst [ms]", "field [ms]", "before [s]",
               "memory [MB]", "force [N]", "deepest [mm]"});
  Json json{{"rows", Json::array()}};
  for (const measure::ProbeRow& row : *rows) {
    table.row({std::to_string(row.nodes), std::to_string(row.points), std::to_string(row.poses),
               number(row.pose_p50_ms, 3), number(row.pose_p99_ms, 3), number(row.pose_max_ms, 3),
               number(row.field_p50_ms, 2), number(row.prepare_s, 1), number(row.megabytes, 0), number(row.force_N, 2),
               number(row.penetration_mm, 4)});
    json["rows"].push_back(
        {{"nodes", row.nodes},
         {"points", row.points},
         {"poses", row.poses},
         {"pose_cpu_ms", {{"p50", row.pose_p50_ms}, {"p99", row.pose_p99_ms}, {"max", row.pose_max_ms}}},
         {"field_cpu_ms", row.field_p50_ms},
         {"prepare_s", row.prepare_s},
         {"megabytes", row.megabytes},
         {"force_N", row.force_N},
         {"penetration_mm", row.penetration_mm}});
  }
  json["machine"] = machine_json();
  console.say(
      "An ultrasound probe moves in the rectum of the demo patient: in, up by 10 mm, out and down, 0.25 mm from pose "
      "to "
      "pose.\n"
      "Areas: parts of the rectal wall on which it presses. Pose: processor time to find the forces, median, 99 % and "
      "worst. Field: median processor time for the displacement of all nodes.\n"
      "Before: time to prepare the wall's compliance, without mesh and factor. Force: towards posterior, with the "
      "array "
      "at the gland's base and a lift of 8 mm. Deepest: largest penetration.");
  console.say(table.text());
  return console.write_json(json);
}

}  // namespace stylet::cli
