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
  if (arguments.nodes > 0) options.nodes = arguments.nodes;
  if (arguments.contacts > 0) options.contacts = arguments.contacts;
  if (arguments.seconds > 0) options.seconds = arguments.seconds;
  if (auto checked = check_nodes("viewers", options.nodes, 500,
                                 "Use 500 nodes or more; this is the coarsest mesh of the demo patient");
      !checked)
    return checked;
  const auto done = measure::bench_viewers(options, console.progress());
  if (!done) return done.error();

  Table table({"viewers", "steps", "p50 [µs]", "p99 [µs]", "p99.9 [µs]", "max [µs]", "late", "p99 of each turn [µs]"});
  const auto add = [&](int viewers, const measure::ViewersReport::Condition& condition) {
    const DeadlineHistogram& times = condition.step_cpu;
    std::string turns;
    for (const std::int64_t p99 : condition.p99_ns) turns += number(us(p99), 0) + " ";
    table.row({std::to_string(viewers), std::to_string(times.count()), number(us(times.quantile_ns(0.5)), 0),
               number(us(times.quantile_ns(0.99)), 0), number(us(times.quantile_ns(0.999)), 0),
               number(us(times.largest_ns()), 0), std::to_string(condition.late), turns});
  };
  add(0, done->without);
  add(done->viewers, done->with);
  const double ratio = us(done->with.step_cpu.quantile_ns(0.99)) / us(done->without.step_cpu.quantile_ns(0.99));
  console.say(
      fmt::format("{} nodes, about {} contacts, 1 kHz: insertions alternate between no viewer and {} viewers, "
                  "each of whom received {:.1f} pictures and {:.2f} MB a second.",
                  done->nodes, options.contacts, done->viewers, done->pictures_per_s, done->megabytes_per_s));
  console.say("Processor time of a step; late: steps that covered more than one period:");
  console.say(table.text());
  console.say(fmt::format("p99 with viewers over p99 without: {:.3f}", ratio));
  return console.write_json({{"nodes", done->nodes},
                             {"viewers", done->viewers},
                             {"pictures_per_s", done->pictures_per_s},
                             {"megabytes_per_s", done->megabytes_per_s},
                             {"without_us", condition_json(done->without)},
                             {"with_us", condition_json(done->with)},
                             {"p99_ratio", ratio},
                             {"machine", machine_json()}});
}

}  // namespace stylet::cli
