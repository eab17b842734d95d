// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "early_warnings.hpp"
#include "output_path.hpp"
#include "table.hpp"
#include "validators.hpp"

#include "stylet/io/dose_input.hpp"
#include "stylet/io/patient_record_io.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/patient/implant.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

namespace stylet::cli {

namespace {

struct ImplantArguments {
  std::string scenario;
  std::string output;
  std::vector<std::string> settings;
  int compensate = 0;
  bool span = false;
  std::string found;
  std::string patient_from;
};

bool is_temporary(const ImplantOutcome& outcome) { return implant_of(outcome.history.seeds) == Implant::temporary; }

std::vector<std::string> error_cells(const std::string& name, const SeedErrors& e) {
  const auto axis = [](const SeedErrors::Axis& a) { return fmt::format("{:.2f} ± {:.2f}", a.mean_mm, a.sd_mm); };
  return {name,
          fmt::format("{}", e.seeds),
          fmt::format("{:.2f}", e.mean_mm),
          fmt::format("{:.2f}", e.p95_mm),
          axis(e.axes[0]),
          axis(e.axes[1]),
          axis(e.axes[2])};
}

std::string errors_text(const ImplantOutcome& outcome) {
  Table table({is_temporary(outcome) ? "dwell positions" : "seeds", "number", "mean [mm]", "95 % [mm]", "left [mm]",
               "posterior [mm]", "superior [mm]"});
  const auto row = [&](const std::string& name, const SeedErrors& e) { table.row(error_cells(name, e)); };
  if (outcome.before) row(outcome.before->name, seed_errors(outcome.before->history.seeds));
  if (outcome.at_planning) row(outcome.at_planning->name, seed_errors(outcome.at_planning->history.seeds));
  row(outcome.before        ? "after compensation"
      : outcome.at_planning ? "at delivery"
                            : "all",
      seed_errors(outcome.history.seeds));
  for (const PartErrors& third : errors_by_third(outcome.history)) row(third.name, third.errors);
  for (const OtherImplant& other : outcome.spans) row(other.name, seed_errors(other.history.seeds));
  return table.text();
}

std::string causes_text(const ImplantOutcome& outcome) {
  Table table({"cause", "mean size [mm]", "left [mm]", "posterior [mm]", "superior [mm]"});
  for (const CauseOfErrors& cause : causes_of_errors(outcome.history.seeds)) {
    const Vec3& mean = cause.mean_vector_mm;
    table.row({to_string(cause.cause), fmt::format("{:.2f}", cause.mean_mm), fmt::format("{:.2f}", mean.x()),
               fmt::format("{:.2f}", mean.y()), fmt::format("{:.2f}", mean.z())});
  }
  return table.text();
}

std::string value_of(const JudgedGoal& goal) { return goal.value ? fmt::format("{:.1f}", *goal.value) : "-"; }

/// The goals, as planned and delivered, and with the other choices.
std::string dose_text(const ImplantOutcome& outcome) {
  std::vector<std::string> head{"goal", "bound", "planned"};
  std::vector<const OtherImplant*> others;
  if (outcome.at_planning) others.push_back(&*outcome.at_planning);
  if (outcome.before) others.push_back(&*outcome.before);
  for (const OtherImplant& other : outcome.spans) others.push_back(&other);
  for (const OtherImplant* other : others) head.push_back(other->name);
  head.insert(head.end(), {"delivered", ""});
  if (outcome.probe_out) head.insert(head.end(), {"probe out", ""});
  if (outcome.found) head.insert(head.end(), {"found", ""});
  Table table(head);
  for (std::size_t k = 0; k < outcome.delivered.goals.size(); ++k) {
    const JudgedGoal& planned = outcome.planned.goals[k];
    const JudgedGoal& delivered = outcome.delivered.goals[k];
    std::vector<std::string> row{delivered.goal.structure + " " + delivered.goal.metric,
                                 fmt::format("{} {:g}", delivered.goal.at_least ? "≥" : "≤", delivered.goal.bound),
                                 value_of(planned)};
    for (const OtherImplant* other : others) row.push_back(value_of(other->delivered.goals[k]));
    const auto judged = [&](const JudgedGoal& goal) {
      row.push_back(value_of(goal));
      row.emplace_back(!goal.value ? "not judged" : goal.met ? "met" : "MISSED");
    };
    judged(delivered);
    if (outcome.probe_out) judged(outcome.probe_out->goals[k]);
    if (outcome.found) judged(outcome.found->dose.goals[k]);
    table.row(row);
  }
  return table.text();
}

/// Figures of the structures that decide about a temporary implant, for which the program has no goals of its own.
std::string target_text(const ImplantOutcome& outcome) {
  Table table({"structure", "figure", "planned", "at planning", "delivered"});
  for (std::size_t k = 0; k < outcome.delivered.structures.size(); ++k) {
    const StructureDose& structure = outcome.delivered.structures[k];
    const bool target = structure.region == "prostate";
    if (!target && structure.region != "urethra" && structure.region != "rectum" && structure.region != "bladder")
      continue;
    const auto figure = [](double Gy) { return std::isfinite(Gy) ? fmt::format("{:.2f}", Gy) : std::string("-"); };
    const auto row = [&](const std::string& name, const auto& of) {
      table.row({structure.name, name, figure(of(outcome.planned.structures[k].dvh)),
                 outcome.at_planning ? figure(of(outcome.at_planning->delivered.structures[k].dvh)) : "-",
                 figure(of(structure.dvh))});
    };
    if (target) row("D90 [Gy]", [](const DoseVolume& dvh) { return dvh.dose_of_percent(90.0); });
    if (const double prescription = outcome.delivered.prescription_Gy; target && prescription > 0.0)
      row("V100 [%]", [&](const DoseVolume& dvh) { return dvh.percent_above(prescription); });
    if (structure.region == "urethra") row("D10 [Gy]", [](const DoseVolume& dvh) { return dvh.dose_of_percent(10.0); });
    if (structure.region == "rectum" || structure.region == "bladder")
      row("D2cc [Gy]", [](const DoseVolume& dvh) { return dvh.dose_of_volume(2.0); });
  }
  return table.text();
}

/// The errors of the seeds that were found, beside those of the simulation.
std::string found_errors_text(const FoundComparison& comparison) {
  Table table({"errors", "number", "mean [mm]", "95 % [mm]", "left [mm]", "posterior [mm]", "superior [mm]"});
  const auto row = [&](const std::string& name, const SeedErrors& e) { table.row(error_cells(name, e)); };
  row("found − planned", comparison.as_found.error);
  row("found − simulated", comparison.as_found.remainder);
  row("found − planned, without common shift", comparison.without_shift.error);
  row("found − simulated, without common shift", comparison.without_shift.remainder);
  return table.text();
}

/// The parts of the mean square of the errors that were found.
std::string found_parts_text(const FoundComparison& comparison) {
  Table table({"part of the mean square error", "as found [mm²]", "[%]", "without common shift [mm²]", "[%]"});
  const auto cells = [](const std::vector<ErrorPart>& parts, const std::string& name) {
    for (const ErrorPart& part : parts) {
      if (part.name == name)
        return std::pair(fmt::format("{:.2f}", part.mean_mm2), fmt::format("{:.0f}", part.percent));
    }
    return std::pair(std::string("-"), std::string("-"));
  };
  for (const ErrorPart& part : comparison.as_found.parts) {
    const auto [mm2, percent] = cells(comparison.as_found.parts, part.name);
    const auto [other_mm2, other_percent] = cells(comparison.without_shift.parts, part.name);
    table.row({part.name, mm2, percent, other_mm2, other_percent});
  }
  return table.text();
}

std::string agreement_text(const FoundComparison& comparison) {
  Table table({"axis", "correlation", "explained [%]"});
  const auto row = [&](const std::string& name, const Agreement& agreement) {
    table.row({name, agreement.correlation ? fmt::format("{:.2f}", *agreement.correlation) : "-",
               agreement.explained_percent ? fmt::format("{:.0f}", *agreement.explained_percent) : "-"});
  };
  row("left", comparison.axes[0]);
  row("posterior", comparison.axes[1]);
  row("superior", comparison.axes[2]);
  row("all", comparison.all);
  return table.text();
}

void say_found(const ImplantHistory& history, const FoundImplant& found, Console& console) {
  std::string sentences = "Found on imaging";
  for (const std::string& sentence : found_sentences(history, found)) sentences += "\n" + sentence;
  console.say(sentences);
  if (found.comparison.seeds.empty()) return;
  console.say("Errors of the seeds that were found (mean ± standard deviation along the axes)\n" +
              found_errors_text(found.comparison));
  console.say(found_parts_text(found.comparison));
  console.say("Simulated errors against those that were found\n" + agreement_text(found.comparison));
}

/// The results must not replace the file that they are computed from.
Result<> check_found_is_no_result(const std::filesystem::path& found, const std::filesystem::path& folder) {
  std::error_code code;
  if (found.empty() || !std::filesystem::equivalent(found, folder / "found.csv", code) || code) return Ok{};
  return input_error(found.string(), "the results in " + folder.string() + " would replace this file",
                     "Keep the found seeds in another folder, or choose another one with -o");
}

/// Tells all doses when and from which files they were computed.
void add_record(ImplantOutcome& outcome, const ImplantArguments& arguments, const Scenario& scenario) {
  const std::vector<DoseInput> inputs = dose_inputs({{"scenario", arguments.scenario},
                                                     {"plan", scenario.plan.file},
                                                     {"patient", scenario.patient.source},
                                                     {"source model", scenario.plan.source},
                                                     {"goals", scenario.plan.goals},
                                                     {"found seeds", arguments.found}});
  std::vector<DoseEvaluation*> doses{&outcome.planned, &outcome.delivered};
  if (outcome.found) doses.push_back(&outcome.found->dose);
  for (DoseEvaluation* dose : doses) {
    dose->inputs = inputs;
    dose->computed_on = date_and_time();
  }
}

Result<> run_implant(const ImplantArguments& arguments, Console& console) {
  const auto scenario = need(read_scenario(arguments.scenario, arguments.settings));
  const std::filesystem::path folder = result_folder(arguments.output, arguments.scenario);
  need(check_output_folder(folder));
  need(check_found_is_no_result(arguments.found, folder));
  warn_before_start(arguments.scenario, arguments.settings, Work::all, console);
  auto outcome = need(implant(scenario, arguments.scenario,
                              {.compensate = arguments.compensate,
                               .span = arguments.span,
                               .found = arguments.found,
                               .patient_from = arguments.patient_from},
                              console.progress()));
  add_record(outcome, arguments, scenario);
  for (const std::string& warning : outcome.warnings) console.warn(warning);
  need(write_implant_results(outcome, folder, console.progress()));
  double seconds = 0.0;
  long steps = 0;
  for (const NeedleHistory& needle : outcome.history.needles) {
    seconds += needle.seconds;
    steps += needle.steps;
  }
  const bool temporary = is_temporary(outcome);
  console.say(fmt::format("{}: {} {}, {} {}, {} nodes; {} steps in {:.1f} s of processor time", scenario.name,
                          outcome.history.needles.size(), temporary ? "catheters" : "needles",
                          outcome.history.seeds.size(), temporary ? "dwell positions" : "seeds", outcome.history.nodes,
                          steps, seconds));
  console.say(patient_sentence(outcome.delivered.patient));
  console.say(
      fmt::format("Distance of the {} from where they were planned (mean ± standard deviation along the axes)\n",
                  temporary ? "dwell positions" : "seeds") +
      errors_text(outcome));
  console.say("Why\n" + causes_text(outcome));
  if (outcome.probe) {
    std::string facts = "Probe";
    for (const ProbeFact& fact : probe_facts(*outcome.probe)) facts += fmt::format("\n{}: {}", fact.name, fact.text);
    console.say(facts);
  }
  if (outcome.found) say_found(outcome.history, *outcome.found, console);
  if (!outcome.delivered.goals.empty()) console.say(dose_text(outcome));
  if (temporary) console.say("Dose\n" + target_text(outcome));
  console.say(fmt::format("Report: {}", (folder / "report.html").string()));
  const Json json = Json::parse(implant_json(outcome));
  return console.write_json(json);
}

}  // namespace

Command add_implant_command(CLI::App& program) {
  auto arguments = std::make_shared<ImplantArguments>();
  CLI::App* app = program.add_subcommand("implant",
                                         "Implant the seeds of a plan, or the catheters of an HDR plan: where seeds "
                                         "come to rest or dwell positions move, why, "
                                         "and the dose that they give");
  option(app, "SCENARIO", arguments->scenario, "SCENARIO.toml",
         "Scenario file with a plan (TOML; stylet insert --print-schema lists its keys)")
      ->required();
  option(app, "-o,--output", arguments->output, "OUT/", "Folder for the results (default: out/NAME)");
  settings_option(app, arguments->settings, "procedure.drop_speed_mm_per_s=10");
  option(app, "--compensate", arguments->compensate, "ROUNDS",
         "Aim the needles beside the plan so that their seeds come to rest where they were planned, correcting the "
         "aim this many times, and show before and after")
      ->check(whole_number_between(0, 20));
  app->add_flag("--span", arguments->span,
                "Also implant in firm and in soft tissue, to show how sure the figures are; takes three times as long");
  option(app, "--found", arguments->found, "SEEDS.csv|RTPLAN",
         "Seeds found on images after the implant, in the coordinates of the plan: match them with the simulated "
         "seeds, and show how much of their errors the simulation explains");
  option(app, "--patient-from", arguments->patient_from, "FILE",
         "DICOM file whose patient, study, frame of reference and structure set the DICOM results get "
         "(default: those of plan and patient, where they agree)");
  return {app, [arguments](Console& console) { return run_implant(*arguments, console); }};
}

}  // namespace stylet::cli
