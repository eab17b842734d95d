// SPDX-License-Identifier: GPL-3.0-or-later
#include "../table.hpp"
#include "benches.hpp"

#include "stylet/measure/event_bench.hpp"
#include "stylet/measure/remesh_bench.hpp"

#include <fmt/format.h>

#include <optional>

namespace stylet::cli {

namespace {

/// Numbers of cells along the edge of a cube whose mesh has at most `nodes` nodes.
std::vector<int> sizes_up_to(int nodes) {
  std::vector<int> cells;
  for (int c = 4; (c + 1) * (c + 1) * (c + 1) <= nodes; c += c < 10 ? 1 : 2) cells.push_back(c);
  return cells;
}

constexpr Index kCoarsest = 570;
const std::vector<std::string> kRules{"interior", "paper", "near-field"};

Json spread_json(const measure::Spread& spread) {
  return {{"p5", spread.p5}, {"p50", spread.p50}, {"p95", spread.p95}, {"max", spread.max}};
}

/// Ratios of processor times: of Woodbury's update to a contact on the coarsest mesh, and of a contact on the finest
/// mesh to one on the coarsest.
struct Ratios {
  double woodbury_over_event = 0.0;
  std::optional<double> finest_over_coarsest;  ///< empty with one mesh only
};
Ratios ratios(const measure::EventBench& bench, const std::string& rule, bool cold) {
  const auto median = [&](const measure::EventRow& row) { return cold ? row.cold_us.p50 : row.warm_us.p50; };
  const measure::EventRow& coarsest = *bench.coarsest(rule);
  const measure::EventRow& finest = *bench.finest(rule);
  const measure::Spread& woodbury = cold ? bench.woodbury_cold_us : bench.woodbury_us;
  Ratios result{woodbury.p50 / median(coarsest), {}};
  if (finest.nodes != coarsest.nodes) result.finest_over_coarsest = median(finest) / median(coarsest);
  return result;
}

void add_events(const measure::EventBench& bench, Json& json) {
  json["events"] = Json::array();
  for (const measure::EventRow& row : bench.rows) {
    json["events"].push_back({{"nodes", row.nodes},
                              {"rule", row.rule},
                              {"points", row.points},
                              {"events", row.events},
                              {"warm_us", spread_json(row.warm_us)},
                              {"cold_us", spread_json(row.cold_us)}});
  }
  json["event_woodbury"] = {{"nodes", bench.woodbury_nodes},
                            {"update_us", spread_json(bench.woodbury_us)},
                            {"update_cold_us", spread_json(bench.woodbury_cold_us)}};
  for (const std::string& rule : kRules) {
    for (const bool cold : {false, true}) {
      const Ratios r = ratios(bench, rule, cold);
      json["event_ratios"][rule][cold ? "cold" : "warm"] = {
          {"woodbury_over_event", r.woodbury_over_event},
          {"finest_over_coarsest", r.finest_over_coarsest ? Json(*r.finest_over_coarsest) : Json(nullptr)}};
    }
  }
}

void say_events(const measure::EventBench& bench, Console& console) {
  Table table({"nodes", "rule", "points", "events", "warm p50 [µs]", "p95", "max", "cold p50 [µs]", "p95", "max"});
  for (const measure::EventRow& row : bench.rows) {
    table.row({std::to_string(row.nodes), row.rule, std::to_string(row.points), std::to_string(row.events),
               number(row.warm_us.p50, 1), number(row.warm_us.p95, 1), number(row.warm_us.max, 1),
               number(row.cold_us.p50, 1), number(row.cold_us.p95, 1), number(row.cold_us.max, 1)});
  }
  need(console.print(
      "Adding a contact at the needle tip in the demo patient: search of the element, border of the system and "
      "compliances with all other points.\n"
      "Rules interior and paper: node addition. Rule near-field: the default, which adds no node. Cold: the processor "
      "caches were emptied before."));
  need(console.print(table.text()));
  const auto spread = [](const measure::Spread& of) {
    return fmt::format("{:.0f} µs ({:.0f} … {:.0f})", of.p50, of.p5, of.p95);
  };
  need(console.print(fmt::format("Woodbury's update of the full inverse at {} nodes: warm {}, cold {}.",
                                 bench.woodbury_nodes, spread(bench.woodbury_us), spread(bench.woodbury_cold_us))));
  for (const std::string& rule : kRules) {
    const Ratios warm = ratios(bench, rule, false);
    const Ratios cold = ratios(bench, rule, true);
    std::string text =
        fmt::format("Adding a contact by the rule {} takes 1/{:.0f} of this update warm and 1/{:.0f} cold", rule,
                    warm.woodbury_over_event, cold.woodbury_over_event);
    if (warm.finest_over_coarsest && cold.finest_over_coarsest) {
      text += fmt::format("; at {} nodes it takes {:.2f} times as long as at {} nodes warm, {:.2f} times cold",
                          bench.finest(rule)->nodes, *warm.finest_over_coarsest, bench.coarsest(rule)->nodes,
                          *cold.finest_over_coarsest);
    }
    need(console.print(text + "."));
  }
}

}  // namespace

Result<> bench_remesh_command(const BenchArguments& arguments, Console& console) {
  const int nodes = arguments.nodes > 0 ? arguments.nodes : kRemeshNodes;
  constexpr int smallest = 125;
  constexpr int largest = 4096;
  if (nodes < smallest || nodes > largest)
    return input_error("--nodes", fmt::format("remesh takes {} to {} nodes, not {}", smallest, largest, nodes),
                       "Give a number in this range, which the memory of the full inverse limits");
  const auto rows = need(measure::bench_remeshing(sizes_up_to(nodes), console.progress()));
  const std::vector<std::string> methods{"shortcut", "bordered", "woodbury", "bcs", "inverse"};
  std::vector<std::string> header{"nodes"};
  for (const std::string& method : methods) header.push_back(method + " [µs]");
  Table table(header);
  Json json{{"rows", Json::array()}};
  for (std::size_t i = 0; i + methods.size() <= rows.size(); i += methods.size()) {
    std::vector<std::string> cells{std::to_string(rows[i].nodes)};
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const measure::RemeshRow& row = rows[i + k];
      cells.push_back(fmt::format("{:.1f}", row.median_us));
      json["rows"].push_back({{"nodes", row.nodes}, {"method", row.method}, {"median_us", row.median_us}});
    }
    table.row(cells);
  }
  measure::EventBenchOptions options;
  if (arguments.nodes > 0) options.largest = kCoarsest;
  const auto events = need(measure::bench_events(options, console.progress()));
  add_events(events, json);
  json["machine"] = machine_json();
  need(console.print("Median processor time of one complete change of the mesh:"));
  need(console.print(table.text()));
  say_events(events, console);
  return console.write_json(json);
}

}  // namespace stylet::cli
