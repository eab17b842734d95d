// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/fluoro_bench.hpp"

#include <fmt/format.h>

namespace stylet::cli {

Result<> bench_fluoro_command(const BenchArguments& arguments, Console& console) {
  measure::FluoroBenchOptions options;
  if (arguments.nodes > 0) options.largest = arguments.nodes;
  if (auto checked = check_nodes("fluoro", options.largest, 3000,
                                 "Give 3000 or more, the nodes of the coarsest mesh that is measured");
      !checked)
    return checked;
  const auto rows = measure::bench_fluoro(options, console.progress());
  if (!rows) return rows.error();
  Table table({"nodes", "pixels", "seeds", "exposures", "median [ms]", "99 % [ms]", "max [ms]"});
  Json json{{"rows", Json::array()}};
  for (const measure::FluoroRow& row : *rows) {
    table.row({std::to_string(row.nodes), fmt::format("{0} × {0}", row.pixels), std::to_string(row.seeds),
               std::to_string(row.exposures), number(1e-3 * row.cpu_us.p50, 2), number(1e-3 * row.cpu_us.p99, 2),
               number(1e-3 * row.cpu_us.max, 2)});
    json["rows"].push_back(
        {{"nodes", row.nodes},
         {"pixels", row.pixels},
         {"seeds", row.seeds},
         {"exposures", row.exposures},
         {"cpu_ms", {{"p50", 1e-3 * row.cpu_us.p50}, {"p99", 1e-3 * row.cpu_us.p99}, {"max", 1e-3 * row.cpu_us.max}}}});
  }
  json["machine"] = machine_json();
  console.say("Processor time of one X-ray picture of the deformed patient with a needle and seeds, on one core.");
  console.say(table.text());
  return console.write_json(json);
}

}  // namespace stylet::cli
