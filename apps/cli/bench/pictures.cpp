// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/pictures_bench.hpp"

namespace stylet::cli {

Result<> bench_pictures_command(const BenchArguments& arguments, Console& console) {
  measure::PicturesBenchOptions options;
  if (arguments.nodes > 0) options.largest = arguments.nodes;
  need(check_nodes("pictures", options.largest, 3000,
                   "Give 3000 or more, the nodes of the coarsest mesh that is measured"));
  const auto rows = need(measure::bench_pictures(options, console.progress()));
  Table table({"nodes", "picture", "median [ms]", "99 % [ms]", "max [ms]", "before [s]"});
  Json json{{"rows", Json::array()}};
  for (const measure::PictureRow& row : rows) {
    table.row({std::to_string(row.nodes), row.picture, number(1e-3 * row.cpu_us.p50, 2),
               number(1e-3 * row.cpu_us.p99, 2), number(1e-3 * row.cpu_us.max, 2), number(row.prepare_s, 1)});
    json["rows"].push_back({{"nodes", row.nodes},
                            {"picture", row.picture},
                            {"cpu_us", times_json(row.cpu_us)},
                            {"prepare_s", row.prepare_s}});
  }
  json["machine"] = machine_json();
  need(console.print(
      "Processor time of a picture of the deformed demo patient, of 60 of each kind, in one thread.\n"
      "Surfaces: all surfaces with the needle's near field. Section: a slice of the patient. Both are computed from "
      "the "
      "forces of an insertion with 40 contacts.\n"
      "Ultrasound and X-ray: a picture with a needle and 20 seeds. Probe: the forces of an ultrasound probe that "
      "presses.\n"
      "Before: processor time before the first picture."));
  need(console.print(table.text()));
  return console.write_json(json);
}

}  // namespace stylet::cli
