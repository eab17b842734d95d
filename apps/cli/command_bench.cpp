// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/benches.hpp"
#include "command.hpp"
#include "table.hpp"
#include "validators.hpp"

#include "stylet/measure/pictures_bench.hpp"
#include "stylet/measure/scale_bench.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/measure/together_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace stylet::cli {

namespace {

/// Refuses options that the chosen benchmark does not use.
Result<> check_options(const BenchArguments& arguments) {
  struct Option {
    const char* name;
    bool given;
    std::vector<std::string> taken_by;
  };
  const Option options[] = {{"--nodes", arguments.nodes > 0, {"remesh", "scale", "pictures"}},
                            {"--contacts", arguments.contacts > 0, {"scale"}},
                            {"--needles", arguments.needles > 0, {"together"}},
                            {"--steps", arguments.steps > 0, {"scale"}}};
  for (const Option& option : options) {
    const std::vector<std::string>& by = option.taken_by;
    if (!option.given || std::find(by.begin(), by.end(), arguments.what) != by.end()) continue;
    return input_error(option.name, fmt::format("bench {} does not have this option", arguments.what),
                       fmt::format("Leave this option out; it belongs to bench {}", fmt::join(by, ", ")));
  }
  return Ok{};
}

Result<> run_bench(const BenchArguments& arguments, Console& console) {
  need(check_options(arguments));
  if (arguments.what == "scale") return bench_scale_command(arguments, console);
  if (arguments.what == "pictures") return bench_pictures_command(arguments, console);
  if (arguments.what == "dose") return bench_dose_command(arguments, console);
  if (arguments.what == "together") return bench_together_command(arguments, console);
  return bench_remesh_command(arguments, console);
}

}  // namespace

Result<> check_nodes(const std::string& benchmark, int nodes, int fewest, const std::string& why) {
  if (nodes >= fewest) return Ok{};
  return input_error("--nodes", fmt::format("{} takes {} nodes or more, not {}", benchmark, fewest, nodes), why);
}

Json machine_json() {
  const measure::Machine machine = measure::this_machine();
  return {{"processor", machine.processor},
          {"cores", machine.cores},
          {"blas", machine.blas},
          {"blas_threads", machine.blas_threads > 0 ? Json(machine.blas_threads) : Json(nullptr)},
          {"compiler", machine.compiler}};
}

std::string number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : std::string("-");
}

Json or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json times_json(const measure::StepTimes& times) {
  return {{"p50", times.p50}, {"p99", times.p99}, {"p999", times.p999}, {"max", times.max}};
}

Command add_bench_command(CLI::App& program) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* app = program.add_subcommand("bench", "Measure performance, and compare methods in one run");
  app->add_option(
         "WHAT", arguments->what,
         "remesh: time of one change of the mesh against the number of nodes, by the default's two rules, by "
         "Woodbury, by boundary condition switches and by an inverse from scratch; scale: time of a step against the "
         "number of nodes and contacts; together: time of a step while other needles rest in the tissue; pictures: "
         "time "
         "of a picture of the deformed patient, of each kind; dose: time of the dose rates of 100 seeds at a million "
         "points, by the formula and by a table")
      ->required()
      ->check(one_of({"remesh", "scale", "together", "pictures", "dose"}));
  option(app, "--nodes", arguments->nodes, "N",
         fmt::format("Nodes of the largest mesh: remesh 125 to 4096 (default {}), scale 570 or more (default "
                     "{}), pictures 3000 or more (default {})",
                     kRemeshNodes, measure::ScaleBenchOptions{}.largest, measure::PicturesBenchOptions{}.largest))
      ->check(whole_number_between(1, 1000000));
  option(app, "--contacts", arguments->contacts, "N",
         "scale: approximate number of contacts (default: one after the other 20, 40 and 60)")
      ->check(whole_number_between(5, measure::most_driven_contacts()));
  option(
      app, "--needles", arguments->needles, "N",
      fmt::format("together: largest number of needles at rest (default {})", measure::TogetherBenchOptions{}.needles))
      ->check(whole_number_between(1, measure::kMostAtRest));
  option(app, "--steps", arguments->steps, "N",
         "scale: repeat insertion and withdrawal until each row has this number of steps (default: once)")
      ->check(whole_number_between(1, 100000000));
  return {app, [arguments](Console& console) { return run_bench(*arguments, console); }};
}

}  // namespace stylet::cli
