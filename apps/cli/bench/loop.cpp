// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/loop_bench.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace stylet::cli {

namespace {

constexpr std::array kEdges_us{50, 75, 100, 125, 150, 200, 300, 400, 500, 700, 1000};

Json histogram_json(const DeadlineHistogram& histogram) {
  const auto us = [&](double q) { return 1e-3 * static_cast<double>(histogram.quantile_ns(q)); };
  Json json{{"count", histogram.count()},
            {"p50", us(0.5)},
            {"p99", us(0.99)},
            {"p999", us(0.999)},
            {"max", 1e-3 * static_cast<double>(histogram.largest_ns())},
            {"over_period", histogram.misses()}};
  json["up_to_us"] = Json::object();
  for (const int edge : kEdges_us) json["up_to_us"][std::to_string(edge)] = histogram.up_to(1000L * edge);
  return json;
}

/// A histogram as text: a bar for the share of steps between two edges. A share above 0 has at least one mark.
std::string bars(const DeadlineHistogram& histogram) {
  constexpr double kWidth = 60.0;
  std::string text;
  std::int64_t before = 0;
  const auto line = [&](const std::string& range, std::int64_t upto) {
    const std::int64_t count = upto - before;
    const double share = static_cast<double>(count) / std::max(1.0, static_cast<double>(histogram.count()));
    const auto length = static_cast<std::size_t>(std::ceil(kWidth * share));
    text += fmt::format("{:>11} us {:>9} {:>8.3f} %  {}\n", range, count, 100.0 * share, std::string(length, '#'));
    before = upto;
  };
  int from = 0;
  for (const int edge : kEdges_us) {
    line(fmt::format("{}-{}", from, edge), histogram.up_to(1000L * edge));
    from = edge;
  }
  line(fmt::format("over {}", from), histogram.count());
  return text;
}

}  // namespace

Result<> bench_loop_command(const BenchArguments& arguments, Console& console) {
  measure::LoopBenchOptions options;
  if (arguments.nodes > 0) options.nodes = arguments.nodes;
  if (arguments.contacts > 0) options.contacts = arguments.contacts;
  if (arguments.seconds > 0) options.seconds = arguments.seconds;
  if (auto checked = check_nodes("loop", options.nodes, 500,
                                 "Use 500 nodes or more; this is the coarsest mesh of the demo patient");
      !checked)
    return checked;
  const auto done = measure::bench_loop(options, console.progress());
  if (!done) return done.error();
  Table table({"", "count", "p50 [µs]", "p99 [µs]", "p99.9 [µs]", "max [µs]", "over a period"});
  Json json{{"nodes", done->nodes},
            {"contacts_max", done->contacts_max},
            {"seconds", done->seconds},
            {"simulated_s", done->simulated_s},
            {"steps", done->counters.steps},
            {"missed_deadlines", done->counters.missed_deadlines},
            {"skipped_periods", done->counters.skipped_periods},
            {"distrusted", done->counters.distrusted},
            {"rights", done->rights.describe()}};
  const auto add = [&](const char* name, const char* key, const DeadlineHistogram& histogram) {
    const auto us = [&](double q) { return number(1e-3 * static_cast<double>(histogram.quantile_ns(q)), 0); };
    table.row({name, std::to_string(histogram.count()), us(0.5), us(0.99), us(0.999),
               number(1e-3 * static_cast<double>(histogram.largest_ns()), 0), std::to_string(histogram.misses())});
    json[key] = histogram_json(histogram);
  };
  add("step, processor time", "step_cpu_us", done->times.step_cpu);
  add("step, wall clock", "step_wall_us", done->times.step_wall);
  add("step, woken late by", "step_late_us", done->times.step_lateness);
  add("device's turn, wall clock", "device_wall_us", done->times.device_wall);
  add("device, woken late by", "device_late_us", done->times.device_lateness);
  json["machine"] = machine_json();
  console.say(
      fmt::format("{} nodes, up to {} contacts, {:.0f} s at 1 kHz: {} steps, {} missed their deadline, {} periods "
                  "skipped, {} steps not trusted.\n{}",
                  done->nodes, done->contacts_max, done->seconds, done->counters.steps, done->counters.missed_deadlines,
                  done->counters.skipped_periods, done->counters.distrusted, done->rights.describe()));
  console.say(table.text());
  console.say("Processor time of a step:");
  console.say(bars(done->times.step_cpu));
  return console.write_json(json);
}

}  // namespace stylet::cli
