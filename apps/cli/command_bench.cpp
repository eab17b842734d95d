// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "table.hpp"
#include "validators.hpp"

#include "stylet/reproduce/measure.hpp"
#include "stylet/reproduce/needle_bench.hpp"
#include "stylet/reproduce/remesh_bench.hpp"

#include <fmt/format.h>

#include <cmath>

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

Json machine_json() {
  const reproduce::Machine machine = reproduce::this_machine();
  return {{"processor", machine.processor},
          {"cores", machine.cores},
          {"blas", machine.blas},
          {"blas_threads", machine.blas_threads > 0 ? Json(machine.blas_threads) : Json(nullptr)},
          {"compiler", machine.compiler}};
}

std::string percent(double share) { return fmt::format("{:.3f}", 100.0 * share); }

Result<> run_needle(Console& console) {
  const auto rows = reproduce::bench_needles();
  if (!rows) return rows.error();
  constexpr auto slopes = reproduce::NeedleRow::kTipSlopes_deg;
  std::vector<std::string> header{"model", "elements", "at L/3", "at L"};
  for (const double slope : slopes) header.push_back(fmt::format("{:.0f} deg", slope));
  header.insert(header.end(), {"axial [N/mm]", "solve [µs]"});
  Table table(header);
  Json json{{"tip_slopes_deg", slopes}, {"rows", Json::array()}};
  for (const reproduce::NeedleRow& row : *rows) {
    std::vector<std::string> cells{row.model, fmt::format("{}{}", row.elements, row.is_default ? " *" : ""),
                                   percent(row.small_inner), percent(row.small_tip)};
    for (const double error : row.elastica) cells.push_back(percent(error));
    const bool stretches = std::isfinite(row.axial_N_per_mm);
    cells.push_back(stretches ? fmt::format("{:.0f}", row.axial_N_per_mm) : "inf");
    cells.push_back(fmt::format("{:.0f}", row.solve_us));
    table.row(cells);
    json["rows"].push_back({{"model", row.model},
                            {"elements", row.elements},
                            {"default", row.is_default},
                            {"error_small_third", row.small_inner},
                            {"error_small_tip", row.small_tip},
                            {"error_elastica_deflection", row.elastica},
                            {"error_elastica_shortening", row.shortening},
                            {"axial_N_per_mm", stretches ? Json(row.axial_N_per_mm) : Json(nullptr)},
                            {"solve_us", row.solve_us}});
  }
  json["machine"] = machine_json();
  console.say(
      "Needle of 200 mm: error in % of the tip's deflection, under a small load at a third of the length and at the "
      "tip,\n"
      "and under a tip force that turns the tip by so many degrees (elastica); stiffness along the axis; processor "
      "time of\n"
      "one solve with 20 loads, median. * = the default number of elements.");
  console.say(table.text());
  return console.write_json(json);
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
  json["machine"] = machine_json();
  console.say("Processor time of one change of the mesh, everything included, median:");
  console.say(table.text());
  return console.write_json(json);
}

}  // namespace

Command add_bench_command(CLI::App& program) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* app = program.add_subcommand("bench", "Measure performance: methods against each other in one run");
  app->add_option(
         "WHAT", arguments->what,
         "remesh: time of one change of the mesh against the number of nodes, by the default's two rules, by "
         "Woodbury, by boundary condition switches, by an inverse from scratch; needle: accuracy of the needle "
         "models against their cost")
      ->required()
      ->check(one_of({"remesh", "needle"}));
  app->add_option("--nodes", arguments->nodes, "remesh: largest mesh, 125 to 4096 nodes")
      ->type_name("N")
      ->check(whole_number_between(125, 4096))
      ->capture_default_str();
  return {app, [arguments](Console& console) {
            return arguments->what == "needle" ? run_needle(console) : run_remesh(*arguments, console);
          }};
}

}  // namespace stylet::cli
