// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/dose_bench.hpp"

#include <fmt/format.h>

namespace stylet::cli {

Result<> bench_dose_command(const BenchArguments&, Console& console) {
  const auto rows = need(measure::bench_dose({}, console.progress()));
  Table table({"formalism", "sources", "points", "formula [s]", "table [s]", "formula / table", "one more [ms]",
               "table / one more", "making the table [ms]", "off by [%]"});
  Json json{{"rows", Json::array()}};
  for (const measure::DoseRow& row : rows) {
    table.row({row.formalism, std::to_string(row.sources), std::to_string(row.points), number(row.exact_s, 2),
               number(row.table_s, 3), number(row.exact_s / row.table_s, 1), number(1000.0 * row.one_more_s, 2),
               number(row.table_s / row.one_more_s, 0), number(1000.0 * row.make_table_s, 1),
               number(row.worst_percent, 4)});
    json["rows"].push_back({{"formalism", row.formalism},
                            {"sources", row.sources},
                            {"points", row.points},
                            {"exact_s", row.exact_s},
                            {"table_s", row.table_s},
                            {"make_table_s", row.make_table_s},
                            {"one_more_s", row.one_more_s},
                            {"exact_over_table", row.exact_s / row.table_s},
                            {"table_over_one_more", row.table_s / row.one_more_s},
                            {"worst_percent", row.worst_percent}});
  }
  json["machine"] = machine_json();
  need(console.print(
      "Dose rates of seeds of model 6711 at random points of a box of 50 mm, on one core. Formula: TG-43 at each "
      "point. "
      "Table: by a table of the dose rate.\n"
      "One more: the time to add one more seed by the table. Off by: the largest difference of the sums by the "
      "table."));
  need(console.print(table.text()));
  return console.write_json(json);
}

}  // namespace stylet::cli
