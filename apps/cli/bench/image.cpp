// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/image_bench.hpp"

#include <fmt/format.h>

namespace stylet::cli {

Result<> bench_image_command(const BenchArguments& arguments, Console& console) {
  measure::ImageBenchOptions options;
  if (arguments.nodes > 0) options.nodes = arguments.nodes;
  if (auto checked = check_nodes("image", static_cast<int>(options.nodes), 570,
                                 "Give 570 or more, the nodes of the coarsest mesh of the demo patient");
      !checked)
    return checked;
  const auto rows = measure::bench_image(options, console.progress());
  if (!rows) return rows.error();
  Table table({"view", "nodes", "lines", "samples", "picture [ms]", "99 %", "speckle alone [ms]", "99 %", "ratio",
               "set up [s]"});
  Json json{{"rows", Json::array()}};
  for (const measure::ImageRow& row : *rows) {
    const double ratio = row.cpu_ms.p50 / row.lattice_ms.p50;
    table.row({row.view, std::to_string(row.nodes), std::to_string(row.lines), std::to_string(row.samples),
               number(row.cpu_ms.p50, 2), number(row.cpu_ms.p99, 2), number(row.lattice_ms.p50, 2),
               number(row.lattice_ms.p99, 2), number(ratio, 2), number(row.set_up_s, 1)});
    json["rows"].push_back({{"view", row.view},
                            {"nodes", row.nodes},
                            {"lines", row.lines},
                            {"samples", row.samples},
                            {"cpu_ms", {{"p50", row.cpu_ms.p50}, {"p99", row.cpu_ms.p99}}},
                            {"lattice_ms", {{"p50", row.lattice_ms.p50}, {"p99", row.lattice_ms.p99}}},
                            {"ratio", ratio},
                            {"set_up_s", row.set_up_s}});
  }
  json["machine"] = machine_json();
  console.say(
      "Ultrasound pictures of the deformed demo patient. Picture: processor time of a whole picture with a needle, its "
      "near field, 20 seeds and artefacts, median and 99 %.\n"
      "Speckle alone: the same picture without needle, seeds, anatomy inside the regions and artefacts. Ratio: picture "
      "over speckle alone.");
  console.say(table.text());
  return console.write_json(json);
}

}  // namespace stylet::cli
