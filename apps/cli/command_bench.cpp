// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/benches.hpp"
#include "command.hpp"
#include "table.hpp"
#include "validators.hpp"

#include "stylet/measure/coupling_bench.hpp"
#include "stylet/measure/needle_bench.hpp"
#include "stylet/measure/scale_bench.hpp"
#include "stylet/measure/step_bench.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/measure/together_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace stylet::cli {

namespace {

std::string percent(double share) { return fmt::format("{:.3f}", 100.0 * share); }

Result<> run_needle(Console& console) {
  const auto rows = measure::bench_needles();
  if (!rows) return rows.error();
  constexpr auto slopes = measure::NeedleRow::kTipSlopes_deg;
  std::vector<std::string> header{"model", "elements", "at L/3", "at L"};
  for (const double slope : slopes) header.push_back(fmt::format("{:.0f} deg", slope));
  header.insert(header.end(), {"axial [N/mm]", "solve [µs]"});
  Table table(header);
  Json json{{"tip_slopes_deg", slopes}, {"rows", Json::array()}};
  for (const measure::NeedleRow& row : *rows) {
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
                            {"axial_N_per_mm", or_null(row.axial_N_per_mm)},
                            {"solve_us", row.solve_us}});
  }
  json["machine"] = machine_json();
  console.say(
      "Needle of 200 mm length. L/3, L: error in % of the tip's deflection under a small load at a third of the length "
      "and at the tip.\n"
      "Degrees: the same error under a tip force that turns the tip by this angle (elastica). Axial: stiffness along "
      "the axis.\n"
      "Solve: median processor time of one solve with 20 loads. * marks the default number of elements.");
  console.say(table.text());
  return console.write_json(json);
}

Json coupling_json(const measure::CouplingRow& row) {
  constexpr double every_s = 0.01;  // time between samples of the curve in the file
  Json curve = Json::array();
  const auto every = static_cast<std::size_t>(std::max(1L, std::lround(every_s / row.curve.dt_s)));
  for (std::size_t k = every; k <= row.curve.force_N.size(); k += every) curve.push_back(row.curve.force_N[k - 1]);
  return {{"study", to_string(row.study)},
          {"method", row.method},
          {"element", row.element},
          {"nodes", row.nodes},
          {"spacing_mm", row.spacing_mm},
          {"dt_ms", row.dt_ms},
          {"peak_N", row.peak_N},
          {"rms_vs_finest_percent", row.rms_vs_finest_percent},
          {"target_shift_mm", row.target_shift_mm},
          {"skin_puncture_mm", or_null(row.skin_mm)},
          {"capsule_puncture_mm", or_null(row.capsule_mm)},
          {"gland_from_mm", or_null(row.gland_from_mm)},
          {"gland_to_mm", or_null(row.gland_to_mm)},
          {"gland_surface_mean_mm", row.surface_mean_mm},
          {"step_cpu_us_p50", row.step_us},
          {"offline_s", row.offline_s},
          {"curve_every_s", every_s},
          {"curve_force_axial_N", curve}};
}

std::vector<std::string> coupling_cells(const measure::CouplingRow& row) {
  return {to_string(row.study),
          row.method,
          row.element,
          std::to_string(row.nodes),
          number(row.spacing_mm, 0),
          number(row.dt_ms, 2),
          number(row.peak_N, 3),
          number(row.rms_vs_finest_percent, 2),
          number(row.target_shift_mm, 4),
          number(row.skin_mm, 2),
          number(row.capsule_mm, 2),
          fmt::format("{} … {}", number(row.gland_from_mm, 1), number(row.gland_to_mm, 1)),
          number(row.surface_mean_mm, 2),
          number(row.step_us, 0),
          number(row.offline_s, 1)};
}

Result<> run_coupling(const BenchArguments& arguments, Console& console) {
  measure::CouplingBenchOptions options;
  if (arguments.nodes > 0) options.largest = arguments.nodes;
  if (auto checked = check_nodes("coupling", options.largest, 500,
                                 "Give 500 or more, the nodes of the coarsest mesh of the demo patient");
      !checked)
    return checked;
  const auto rows = measure::bench_coupling(options, console.progress());
  if (!rows) return rows.error();
  Table table({"over", "method", "element", "nodes", "spacing [mm]", "dt [ms]", "peak [N]", "RMS [%]", "shift [mm]",
               "skin [mm]", "capsule [mm]", "gland [mm]", "off by [mm]", "step [µs]", "before [s]"});
  Json json{{"depth_mm", options.depth_mm}, {"rows", Json::array()}};
  for (const measure::CouplingRow& row : *rows) {
    table.row(coupling_cells(row));
    json["rows"].push_back(coupling_json(row));
  }
  json["machine"] = machine_json();
  console.say(fmt::format(
      "The insertion of the demo scenario, in to {:g} mm and out. RMS: root mean square difference of the axial force "
      "from the finest run of the same study and method, relative to the peak of that run.\n"
      "Shift: displacement of the gland's centroid. Skin, capsule: depth of the base when they are punctured. Gland: "
      "where the needle's line lies inside the gland of the mesh.\n"
      "Off by: mean distance of the gland's surface in the mesh from the contours. Step: median processor time of a "
      "step. Before: time for all computations before the needle moves.",
      options.depth_mm));
  console.say(table.text());
  return console.write_json(json);
}

/// Refuses options that the chosen benchmark does not use.
Result<> check_options(const BenchArguments& arguments) {
  struct Option {
    const char* name;
    bool given;
    std::vector<std::string> taken_by;
  };
  const Option options[] = {{"--nodes",
                             arguments.nodes > 0,
                             {"remesh", "coupling", "scale", "step", "loop", "viewers", "pictures", "supply", "display",
                              "image", "fluoro", "probe"}},
                            {"--contacts", arguments.contacts > 0, {"scale", "loop", "viewers", "pictures"}},
                            {"--needles", arguments.needles > 0, {"together"}},
                            {"--steps", arguments.steps > 0, {"scale"}},
                            {"--seconds", arguments.seconds > 0.0, {"loop", "viewers", "pictures"}},
                            {"--speed", arguments.speed > 0.0, {"supply"}}};
  for (const Option& option : options) {
    const std::vector<std::string>& by = option.taken_by;
    if (!option.given || std::find(by.begin(), by.end(), arguments.what) != by.end()) continue;
    return input_error(option.name, fmt::format("bench {} does not have this option", arguments.what),
                       fmt::format("Leave this option out; it belongs to bench {}", fmt::join(by, ", ")));
  }
  return Ok{};
}

Result<> run_bench(const BenchArguments& arguments, Console& console) {
  if (auto checked = check_options(arguments); !checked) return checked;
  if (arguments.what == "needle") return run_needle(console);
  if (arguments.what == "coupling") return run_coupling(arguments, console);
  if (arguments.what == "scale") return bench_scale_command(arguments, console);
  if (arguments.what == "step") return bench_step_command(arguments, console);
  if (arguments.what == "loop") return bench_loop_command(arguments, console);
  if (arguments.what == "supply") return bench_supply_command(arguments, console);
  if (arguments.what == "display") return bench_display_command(arguments, console);
  if (arguments.what == "fluoro") return bench_fluoro_command(arguments, console);
  if (arguments.what == "image") return bench_image_command(arguments, console);
  if (arguments.what == "probe") return bench_probe_command(arguments, console);
  if (arguments.what == "dose") return bench_dose_command(arguments, console);
  if (arguments.what == "together") return bench_together_command(arguments, console);
  if (arguments.what == "viewers" || arguments.what == "pictures") return bench_viewers_command(arguments, console);
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
         "Woodbury, by boundary condition switches and by an inverse from scratch; step: processor time of the phases "
         "of a step; coupling: force of one insertion against mesh, spacing of contacts and time step, with the near "
         "field and with node addition; scale: time of a step against the number of nodes and contacts; loop: duration "
         "and lateness of the steps of the real-time loop; supply: speeds that a needle can have where no compliance "
         "was precomputed; display: time and error of a picture of the deformed patient; viewers: time of the steps of "
         "a live session without viewers and with two viewers; pictures: the same without and with ultrasound pictures "
         "made beside it; needle: accuracy of the needle models against their "
         "cost; dose: time of the dose rates of 100 seeds at a million points, by the formula and by a table; "
         "image: time of an ultrasound picture; fluoro: time of an X-ray picture; probe: time to find how an "
         "ultrasound "
         "probe presses the rectal wall; together: time of a step while other needles rest in the tissue")
      ->required()
      ->check(one_of({"remesh", "step", "coupling", "scale", "loop", "supply", "display", "image", "fluoro", "probe",
                      "viewers", "pictures", "needle", "dose", "together"}));
  app->add_option("--nodes", arguments->nodes,
                  fmt::format("Nodes of the largest mesh: remesh 125 to 4096 (default {}), coupling 500 or more "
                              "(default {}), scale, supply and display 570 or more (default {}), fluoro "
                              "and probe 3000 or more (default 20000). Nodes of the only mesh: step, loop, "
                              "viewers and pictures 500 or more (default {}), image 570 or more (default 5000)",
                              kRemeshNodes, measure::CouplingBenchOptions{}.largest,
                              measure::ScaleBenchOptions{}.largest, measure::StepBenchOptions{}.nodes))
      ->type_name("N")
      ->check(whole_number_between(1, 1000000));
  app->add_option("--contacts", arguments->contacts,
                  "Approximate number of contacts: scale one number (default 20, 40 and 60), loop, viewers and "
                  "pictures (default 40)")
      ->type_name("N")
      ->check(whole_number_between(5, measure::most_driven_contacts()));
  app->add_option("--needles", arguments->needles,
                  fmt::format("together: largest number of needles at rest (default {})",
                              measure::TogetherBenchOptions{}.needles))
      ->type_name("N")
      ->check(whole_number_between(1, measure::kMostAtRest));
  app->add_option("--steps", arguments->steps,
                  "scale: repeat insertion and withdrawal until each row has this number of steps (default: once)")
      ->type_name("N")
      ->check(whole_number_between(1, 100000000));
  app->add_option("--seconds", arguments->seconds,
                  "loop, viewers and pictures: duration in seconds of real time (default 30, 120 and 120)")
      ->type_name("S")
      ->check(number_between(1.0, 86400.0));
  app->add_option("--speed", arguments->speed,
                  "supply: speed of the needle's base in mm/s (default 2, 5, 10, 20 and 50)")
      ->type_name("V")
      ->check(number_between(0.5, 100.0));
  return {app, [arguments](Console& console) { return run_bench(*arguments, console); }};
}

}  // namespace stylet::cli
