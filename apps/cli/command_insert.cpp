// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "describe.hpp"
#include "early_warnings.hpp"
#include "map_text.hpp"
#include "output_path.hpp"
#include "recorded_run.hpp"
#include "table.hpp"

#include "stylet/io/event_words.hpp"
#include "stylet/io/hole_map_io.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/patient/insert.hpp"
#include "stylet/sim/hole_map.hpp"
#include "stylet/sim/tenting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>

namespace stylet::cli {

namespace {

struct InsertArguments {
  std::string scenario;
  std::string output;
  std::vector<std::string> settings;
  bool map = false;  ///< --map: the map of the template's holes
  bool print_schema = false;
  bool print_tissues = false;
};

/// The changes of the mesh in words, such as "9 nodes moved (ΔK of order 42…54); 4 nodes added (ΔK of order 15)"; empty
/// without changes.
std::string mesh_changes_text(const Summary& summary) {
  struct Tally {
    int count = 0;
    int low = std::numeric_limits<int>::max();
    int high = 0;
    [[nodiscard]] std::string text(const char* what) const {
      return fmt::format("{} node{} {} (ΔK of order {})", count, count == 1 ? "" : "s", what,
                         low == high ? fmt::format("{}", low) : fmt::format("{}…{}", low, high));
    }
  };
  Tally moved;
  Tally added;
  std::map<std::string, int> refused;
  double condition = 0.0;
  for (const MeshChange& m : summary.mesh_changes) {
    Tally& tally = m.change.kind == RemeshEvent::Kind::repositioned ? moved : added;
    ++tally.count;
    tally.low = std::min(tally.low, m.change.dimension);
    tally.high = std::max(tally.high, m.change.dimension);
    if (m.change.refused != RemeshEvent::Refused::no) ++refused[to_string(m.change.refused)];
    if (std::isfinite(m.change.condition)) condition = std::max(condition, m.change.condition);
  }
  std::vector<std::string> parts;
  if (moved.count > 0) parts.push_back(moved.text("moved"));
  if (added.count > 0) parts.push_back(added.text("added"));
  static const std::map<std::string, const char*> reasons{
      {"boundary", "the nearest node shapes an organ's surface"},
      {"fixed", "the nearest node is fixed"},
      {"held", "the needle already holds the nearest node"},
      {"contacts", "contacts are interpolated around the nearest node"},
      {"inverts", "moving the nearest node would flatten an element"}};
  for (const auto& [reason, count] : refused)
    parts.push_back(fmt::format("{} × added because {}", count, reasons.at(reason)));
  if (condition > 0.0) parts.push_back(fmt::format("condition of the small matrix at most {:.0f}", condition));
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// A number with three decimals; a number that rounds to 0 has no sign.
std::string thousandths(double value) { return fmt::format("{:.3f}", std::abs(value) < 5e-4 ? 0.0 : value); }

/// The gland's motion in clinical terms: a table of its shifts, its rotation and its change of volume.
std::string gland_text(const GlandMotion& gland) {
  Table shifts({"gland moved", "total [mm]", "left", "posterior", "superior"});
  for (const NamedShift& shift : named_shifts(gland)) {
    if (!shift.mm) {
      shifts.row({shift.name, "", "", "", ""});
      continue;
    }
    const Vec3& mm = *shift.mm;
    shifts.row({shift.name, thousandths(mm.norm()), thousandths(mm.x()), thousandths(mm.y()), thousandths(mm.z())});
  }
  std::string turns;
  for (const NamedTurn& turn : named_turns(gland))
    turns +=
        fmt::format("{}{} {}° ({})", turns.empty() ? "" : ", ", turn.plane, thousandths(turn.degrees), turn.direction);
  Facts facts;
  facts.add("gland turned", turns);
  facts.add("gland volume", fmt::format("changed by {} %", thousandths(gland.volume_change_percent)));
  return shifts.text() + "\n\n" + facts.text();
}

std::string summary_text(const Summary& summary) {
  Table events({"event", "time [s]", "base depth [mm]", "axial force [N]"});
  results::EventWords words;
  for (const Event& event : summary.events) {
    const std::string what = words.clause(event);
    if (what.empty()) continue;  // the puncture at the same place has been said
    // A force that rounds to 0 has no sign.
    const double force = std::abs(event.force_N) < 5e-4 ? 0.0 : event.force_N;
    events.row({what, fmt::format("{:.3f}", event.time_s), fmt::format("{:.2f}", event.depth_mm),
                fmt::format("{:.3f}", force)});
  }
  Facts facts;
  facts.add("peak force", fmt::format("axial {:.2f} N, sagittal {:.3f} N, lateral {:.3f} N", summary.peak_axial_N,
                                      summary.peak_sagittal_N, summary.peak_lateral_N));
  if (!summary.target_shifts.empty()) {
    const Vec3& shift = summary.target_shift_centroid_mm;
    facts.add("target moved", fmt::format("{:.2f} mm on average (left {:.2f}, posterior {:.2f}, superior {:.2f}), at "
                                          "most {:.2f} mm, at the deepest point",
                                          shift.norm(), shift.x(), shift.y(), shift.z(), summary.target_shift_max_mm));
  }
  if (summary.tip_error_mm) {
    const Vec3& error = *summary.tip_error_mm;
    facts.add("tip off its target",
              fmt::format("{:.2f} mm in the tissue (left {:.2f}, posterior {:.2f}, superior {:.2f}), at the "
                          "deepest point",
                          error.norm(), error.x(), error.y(), error.z()));
  }
  if (summary.in_place) {
    const NeedlesInPlace& held = *summary.in_place;
    std::string text = fmt::format("{}", fmt::join(held.holes, ", "));
    if (held.shift_mm && held.shift_max_mm) {
      text += fmt::format("; they had moved the gland by {:.2f} mm before, the needle moved it further by {:.2f} mm",
                          held.shift_mm->norm(), held.shift_max_mm->norm());
    }
    if (held.tip_error_mm)
      text += fmt::format("; tip off its target in the tissue as they hold it: {:.2f} mm", held.tip_error_mm->norm());
    facts.add("needles in place", text);
  }
  facts.add("tip deflection", fmt::format("at most {:.2f} mm", summary.tip_deflection_mm));
  facts.add("balance", fmt::format("force {:.1e}, torque {:.1e} (relative)", summary.residual_force_balance,
                                   summary.residual_torque_balance));
  facts.add("step",
            fmt::format("processor time median {:.0f} µs, 99 % {:.0f} µs, 99.9 % {:.0f} µs, worst {:.0f} µs; {} "
                        "steps, at most {} contacts",
                        summary.step_us_p50, summary.step_us_p99, summary.step_us_p999, summary.step_us_max,
                        summary.steps, summary.contacts_max));
  if (const std::string changes = mesh_changes_text(summary); !changes.empty()) facts.add("mesh", changes);
  const std::string gland = summary.gland ? gland_text(*summary.gland) + "\n\n" : "";
  return events.text() + "\n\n" + gland + facts.text();
}

/// A table of all tissues with their properties and the tenting and cutting lag that follow for the scenario's needle.
std::string tissues_text(const Scenario& scenario) {
  const double diameter = scenario.needle.diameter_mm;
  Table table(
      {"region", "E [kPa]", "nu", "stiffening", "cutting [N]", "puncture [N]", "tenting [mm]", "cutting lag [mm]"});
  std::vector<std::string> regions = known_tissues();
  for (const auto& [region, given] : scenario.tissue) {
    if (std::find(regions.begin(), regions.end(), region) == regions.end()) regions.push_back(region);
  }
  std::string sources;
  for (const std::string& region : regions) {
    const TissueParameters t = tissue_of(scenario, region);
    const bool bone = t.young_kPa > 1e4;
    table.row({region, bone ? "held" : fmt::format("{:g}", t.young_kPa), bone ? "" : fmt::format("{:g}", t.poisson),
               bone ? "" : fmt::format("{:g}", t.stiffening), bone ? "" : fmt::format("{:g}", t.cutting_N),
               bone ? "" : fmt::format("{:g}", t.puncture_N),
               bone || t.puncture_N <= 0.0 ? "" : fmt::format("{:.1f}", tenting_mm(t, t.puncture_N, diameter)),
               bone ? "" : fmt::format("{:.1f}", cutting_lag_mm(t, t.cutting_N, diameter))});
    sources += fmt::format("\n  {}: {}", region, t.source);
  }
  return table.text() + "\n\nSources of the defaults" + sources;
}

/// The table of --print-tissues: the default values, or the values of a scenario.
std::string tissues_text(const InsertArguments& arguments) {
  if (!arguments.scenario.empty()) return tissues_text(need(read_scenario(arguments.scenario, arguments.settings)));
  if (!arguments.settings.empty())
    throw Failed{input_error("insert --print-tissues", "--set has no scenario to change",
                             "Give a scenario file, for example scenarios/demo.toml")};
  return tissues_text(Scenario{});
}

/// Reads summary.json from the result folder.
Json written_summary(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "summary.json";
  std::ifstream file(path);
  Json json = Json::parse(file, nullptr, false);
  if (json.is_discarded()) throw Failed{failure(path.string(), "cannot be read back", "Check the result folder")};
  return json;
}

bool is_recording(const std::string& file) { return is_hdf5_file(file) && !is_meant_as_model(file); }

/// Prepares the input: a recording with its steps, or a scenario or saved model, which has no steps.
RecordedRun what_to_run(const InsertArguments& arguments, const Progress& progress) {
  if (is_recording(arguments.scenario)) return need(recorded_run(arguments.scenario, arguments.settings, progress));
  RecordedRun run;
  run.prepared = need(prepare_model_file(arguments.scenario, arguments.settings, progress));
  return run;
}

/// The JSON document of --json: the summary, and the map if there is one.
Json result_json(const std::filesystem::path& folder, const std::optional<HoleMap>& map) {
  Json json = written_summary(folder);
  if (map) json["map"] = Json::parse(hole_map_json(*map));
  return json;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code code;
  return std::filesystem::equivalent(a, b, code);
}

Result<> run_insert(const InsertArguments& arguments, Console& console) {
  if (arguments.print_schema) return console.print(schema_text());
  if (arguments.print_tissues) return console.print(tissues_text(arguments));
  if (arguments.scenario.empty())
    return input_error("insert", "no scenario is given", "Give a scenario file, for example scenarios/demo.toml");
  const std::filesystem::path folder = result_folder(arguments.output, arguments.scenario);
  need(check_output_folder(folder));
  if (arguments.map && is_recording(arguments.scenario)) {
    return input_error(arguments.scenario,
                       "it is a recording, whose base motion belongs to one needle and cannot be repeated through "
                       "every hole of the template",
                       "Give the scenario of the recording instead, or leave --map out");
  }

  warn_before_start(arguments.scenario, arguments.settings, Work::all, console);
  auto source = what_to_run(arguments, console.progress());
  const PreparedModel& prepared = source.prepared;
  const bool repeats = !source.steps.empty();
  if (repeats && same_file(folder / "run.h5", arguments.scenario))
    return input_error(folder.string(), "the recording would be replaced by its repetition",
                       "Give another folder with -o");
  const std::vector<std::string> warnings = prepared.warnings();
  const auto warn = [&] {
    for (const std::string& warning : warnings) console.warn(warning);
  };
  const auto result = need(insert(
      prepared, folder, {.map = arguments.map, .recorded = source.steps, .where = arguments.scenario, .begin = warn},
      console.progress()));

  const Summary& summary = result.summary;
  for (std::size_t i = warnings.size(); i < summary.warnings.size(); ++i) console.warn(summary.warnings[i]);
  console.say(fmt::format("{}: {} nodes, {} tetrahedra, {}", prepared.model->scenario().name, summary.nodes,
                          summary.tets, prepared.model->info().method));
  if (result.probe) {
    Facts probe;
    for (const ProbeFact& fact : probe_facts(*result.probe)) probe.add(fact.name, fact.text);
    console.say(probe.text() + "\n");
  }
  console.say(summary_text(summary));
  if (result.map) console.say("\n" + map_text(*result.map));
  if (repeats) console.say("Repeated the recording: " + compare_forces(source.steps, result.steps) + ".");
  console.say(fmt::format("Report: {}", (folder / "report.html").string()));
  return console.write_json(result_json(folder, result.map));
}

}  // namespace

Command add_insert_command(CLI::App& program) {
  auto arguments = std::make_shared<InsertArguments>();
  CLI::App* app =
      program.add_subcommand("insert", "Insert a needle: run a scenario and write forces, displacements and a report");
  option(app, "SCENARIO", arguments->scenario, "SCENARIO.toml",
         "Scenario file (TOML; --print-schema lists its keys), a model saved by `stylet prepare`, or the run.h5 of a "
         "recording, whose base motion is then repeated step by step");
  option(app, "-o,--output", arguments->output, "OUT/", "Folder for the results (default: out/NAME)");
  settings_option(app, arguments->settings, "mesh.nodes=5000");
  // Short options for the settings in which this program and Goksel et al. 2005 differ.
  const auto shorthand = [&](const char* option, const char* key, const char* meaning) {
    app->add_option_function<std::string>(
           option,
           [arguments, key](const std::string& word) {
             arguments->settings.push_back(fmt::format("{}=\"{}\"", key, word));
           },
           fmt::format("{}; the same as --set {}=…", meaning, key))
        ->type_name("WORD");
  };
  shorthand("--method", "coupling.method", "near-field, node-addition, node-repositioning or embedded");
  shorthand("--rule", "coupling.rule", "rule for the place where nodes are added: interior or paper");
  shorthand("--engine", "coupling.engine", "form in which the inverse stiffness is kept: condensed, woodbury or bcs");
  shorthand("--solver", "coupling.solver", "coupled or staggered");
  shorthand("--needle", "needle.model", "beam, springs or tet");
  app->add_flag("--map", arguments->map,
                "Also insert a needle through each hole of the template: print its distances from bone, urethra and "
                "rectum, the shift of the gland and the error of the tip; also written as map.csv and into the report");
  app->add_flag("--print-schema", arguments->print_schema,
                "Print every key of a scenario with unit, default, range and meaning");
  app->add_flag(
      "--print-tissues", arguments->print_tissues,
      "Print the properties of every tissue with their sources: the default values, or the values of a scenario and "
      "--set");
  return {app, [arguments](Console& console) { return run_insert(*arguments, console); }};
}

}  // namespace stylet::cli
