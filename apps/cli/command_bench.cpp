// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "table.hpp"
#include "validators.hpp"

#include "stylet/reproduce/measure.hpp"
#include "stylet/reproduce/remesh_bench.hpp"

#include <fmt/format.h>

namespace stylet::cli {

namespace {

struct BenchArguments {
  std::string what;
  int nodes = 1331;
};

/// Sizes of a cube, by its cells, up to a number of nodes.
std::vector<int> sizes_up_to(int nodes) {
  std::vector<int> cells;
  for (int c = 4; (c + 1) * (c + 1) * (c + 1) <= nodes; c += c < 10 ? 1 : 2) cells.push_back(c);
  return cells;
}

Result<> run_remesh(const BenchArguments& arguments, Console& console) {
  const auto rows = reproduce::bench_remeshing(sizes_up_to(arguments.nodes), console.progress());
  if (!rows) return rows.error();
  const std::vector<std::string> methods{"shortcut", "bordered", "woodbury", "bcs", "inverse"};
  std::vector<std::string> header{"nodes"};
  for (const std::string& method : methods) header.push_back(method + " [µs]");
  Table table(header);
  Json json{{"rows", Json::array()}};
  for (std::size_t i = 0; i + methods.size() <= rows->size(); i += methods.size()) {
    std::vector<std::string> cells{std::to_string((*rows)[i].nodes)};
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const reproduce::RemeshRow& row = (*rows)[i + k];
      cells.push_back(fmt::format("{:.1f}", row.median_us));
      json["rows"].push_back({{"nodes", row.nodes}, {"method", row.method}, {"median_us", row.median_us}});
    }
    table.row(cells);
  }
  const reproduce::Machine machine = reproduce::this_machine();
  json["machine"] = {{"processor", machine.processor},
                     {"cores", machine.cores},
                     {"blas", machine.blas},
                     {"blas_threads", machine.blas_threads > 0 ? Json(machine.blas_threads) : Json(nullptr)},
                     {"compiler", machine.compiler}};
  console.say("Processor time of one change of the mesh, everything included, median:");
  console.say(table.text());
  return console.write_json(json);
}

}  // namespace

Command add_bench_command(CLI::App& program) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* app = program.add_subcommand("bench", "Measure performance: methods against each other in one run");
  app->add_option("WHAT", arguments->what,
                  "remesh: time of one change of the mesh against the number of nodes, by the default's two rules, by "
                  "Woodbury, by boundary condition switches, by an inverse from scratch")
      ->required()
      ->check(one_of({"remesh"}));
  app->add_option("--nodes", arguments->nodes, "Largest mesh, 125 to 4096 nodes")
      ->type_name("N")
      ->check(whole_number_between(125, 4096))
      ->capture_default_str();
  return {app, [arguments](Console& console) { return run_remesh(*arguments, console); }};
}

}  // namespace stylet::cli
