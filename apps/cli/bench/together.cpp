// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/together_bench.hpp"

namespace stylet::cli {

Result<> bench_together_command(const BenchArguments& arguments, Console& console) {
  measure::TogetherBenchOptions options;
  if (arguments.needles > 0) options.needles = arguments.needles;
  const auto rows = need(measure::bench_together(options, console.progress()));
  Table table({"at rest", "contacts", "of all", "steps", "flagged", "iterations", "p50 [µs]", "p99 [µs]", "max [µs]",
               "p50 / alone", "p99 / alone"});
  Json json{{"rows", Json::array()}};
  const measure::StepTimes& alone = rows.front().cpu_us;
  for (const measure::TogetherRow& row : rows) {
    table.row({std::to_string(row.at_rest), std::to_string(row.contacts), std::to_string(row.contacts_in_all),
               std::to_string(row.steps), std::to_string(row.flagged), number(row.iterations, 2),
               number(row.cpu_us.p50, 0), number(row.cpu_us.p99, 0), number(row.cpu_us.max, 0),
               number(row.cpu_us.p50 / alone.p50, 1), number(row.cpu_us.p99 / alone.p99, 1)});
    json["rows"].push_back({{"at_rest", row.at_rest},
                            {"contacts", row.contacts},
                            {"contacts_in_all", row.contacts_in_all},
                            {"steps", row.steps},
                            {"flagged", row.flagged},
                            {"iterations", row.iterations},
                            {"step_cpu_us", times_json(row.cpu_us)},
                            {"p50_over_alone", row.cpu_us.p50 / alone.p50},
                            {"p99_over_alone", row.cpu_us.p99 / alone.p99}});
  }
  json["machine"] = machine_json();
  need(console.print(
      "Processor time of a step of the demo's needle, from 40 to 85 mm, while others rest at 85 mm around it, 5 mm "
      "apart.\n"
      "Contacts: of the moving needle, and of all needles. Flagged: steps without a balance. Alone: the first row."));
  need(console.print(table.text()));
  return console.write_json(json);
}

}  // namespace stylet::cli
