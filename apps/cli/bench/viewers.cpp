// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/viewers_bench.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::cli {

namespace {

double us(std::int64_t ns) { return 1e-3 * static_cast<double>(ns); }

Json condition_json(const measure::ViewersReport::Condition& condition) {
  const DeadlineHistogram& times = condition.step_cpu;
  Json turns = Json::array();
  for (const std::int64_t p99 : condition.p99_ns) turns.push_back(us(p99));
  return {{"count", times.count()},
          {"p50", us(times.quantile_ns(0.5))},
          {"p99", us(times.quantile_ns(0.99))},
          {"p999", us(times.quantile_ns(0.999))},
          {"max", us(times.largest_ns())},
          {"p99_of_turns", turns},
          {"late", condition.late}};
}

}  // namespace

Result<> bench_viewers_command(const BenchArguments& arguments, Console& console) {
  measure::ViewersBenchOptions options;
  options.ultrasound = arguments.what == "pictures";
  if (arguments.nodes > 0) options.nodes = arguments.nodes;
  if (arguments.contacts > 0) options.contacts = arguments.contacts;
  if (arguments.seconds > 0) options.seconds = arguments.seconds;
  if (auto checked = check_nodes(arguments.what, options.nodes, 500,
                                 "Give 500 or more, the nodes of the coarsest mesh of the demo patient");
      !checked)
    return checked;
  const auto done = measure::bench_viewers(options, console.progress());
  if (!done) return done.error();

  const std::string beside = options.ultrasound ? "ultrasound" : "viewers";
  Table table({beside, "steps", "p50 [µs]", "p99 [µs]", "p99.9 [µs]", "max [µs]", "late", "p99 of each turn [µs]"});
  const auto add = [&](const std::string& what, const measure::ViewersReport::Condition& condition) {
    const DeadlineHistogram& times = condition.step_cpu;
    std::string turns;
    for (const std::int64_t p99 : condition.p99_ns) turns += number(us(p99), 0) + " ";
    table.row({what, std::to_string(times.count()), number(us(times.quantile_ns(0.5)), 0),
               number(us(times.quantile_ns(0.99)), 0), number(us(times.quantile_ns(0.999)), 0),
               number(us(times.largest_ns()), 0), std::to_string(condition.late), turns});
  };
  add(options.ultrasound ? "no" : "0", done->without);
  add(options.ultrasound ? "yes" : std::to_string(done->viewers), done->with);
  const std::string what =
      options.ultrasound
          ? fmt::format("no pictures and ultrasound of a probe that presses; {:.1f} pictures were made per second",
                        done->ultrasound_per_s)
          : fmt::format(
                "no viewer and {} viewers; each viewer received {:.1f} pictures and {:.2f} MB per "
                "second",
                done->viewers, done->pictures_per_s, done->megabytes_per_s);
  console.say(fmt::format("{} nodes, about {} contacts, 1 kHz. Insertions alternate between {}.", done->nodes,
                          options.contacts, what));
  console.say(
      "Processor time of a step. Late: number of steps that started half a period or more after they were due.");
  console.say(table.text());
  console.say(
      fmt::format("Ratio of p99 with {0} to p99 without, medians of the turns: {1:.3f}", beside, done->p99_ratio()));
  return console.write_json({{"nodes", done->nodes},
                             {"viewers", done->viewers},
                             {"pictures_per_s", done->pictures_per_s},
                             {"megabytes_per_s", done->megabytes_per_s},
                             {"ultrasound_per_s", done->ultrasound_per_s},
                             {"without_us", condition_json(done->without)},
                             {"with_us", condition_json(done->with)},
                             {"p99_ratio", done->p99_ratio()},
                             {"machine", machine_json()}});
}

}  // namespace stylet::cli
