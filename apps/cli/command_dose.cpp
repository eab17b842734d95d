// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "output_path.hpp"

#include "table.hpp"
#include "validators.hpp"

#include "stylet/dose/evaluate.hpp"
#include "stylet/dose/fitting_sources.hpp"
#include "stylet/dose/plan_rules.hpp"
#include "stylet/io/dose_input.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/io/dose_results.hpp"
#include "stylet/io/patient_record_io.hpp"
#include "stylet/patient/dose_structures.hpp"
#include "stylet/patient/fit.hpp"
#include "stylet/patient/source_choice.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <iostream>

namespace stylet::cli {

namespace {

namespace fs = std::filesystem;

struct DoseArguments {
  std::string plan, structures, patient_from, output, formalism, quantity, compare, points, goals;
  std::vector<double> compare_shift_mm;
  std::vector<std::string> sources, regions, skip;
  double phi_an = 0, prescription_Gy = 0, days = 0, decay_days = 0, grid_mm = 1, step_mm = 0;
  bool ignore_frame = false, compare_anyway = false;
};

DoseOptions options_of(const DoseArguments& arguments, const DosePlan& plan) {
  DoseOptions options;
  for (const DoseFormalism formalism : {DoseFormalism::line2d, DoseFormalism::line1d, DoseFormalism::point}) {
    if (arguments.formalism == to_string(formalism)) options.formalism = formalism;
  }
  if (arguments.quantity == "rate") options.quantity = DoseQuantity::initial_rate;
  if (arguments.days > 0) options.quantity = DoseQuantity::until;
  if (arguments.days > 0 && arguments.quantity == "rate")
    throw Failed{input_error("--days", "a dose rate has no duration", "Leave out --days or --quantity rate")};
  if (plan.implant == Implant::temporary && (arguments.days > 0 || arguments.quantity == "rate"))
    throw Failed{input_error(arguments.plan, "the plan is a temporary implant, which has its total dose only",
                             "Leave out --days and --quantity")};
  options.days = arguments.days;
  options.decay_days = arguments.decay_days;
  options.compare_anyway = arguments.compare_anyway;
  options.prescription_Gy = arguments.prescription_Gy;
  options.grid_step_mm = arguments.grid_mm;
  if (!arguments.points.empty()) {
    options.points = need(read_points(arguments.points));
  }
  if (!arguments.goals.empty()) {
    options.goals = need(read_goals(arguments.goals));
  } else if (plan.implant == Implant::permanent) {
    const auto own = permanent_prostate_goals();
    options.goals.assign(own.begin(), own.end());
  }
  return options;
}

/// The source models of the plan, with the constant anisotropy that the user may give.
std::vector<SourceModel> sources_of(const DoseArguments& arguments, const DosePlan& plan) {
  auto sources = need(choose_sources(arguments.sources, plan));
  if (arguments.phi_an <= 0) return sources;
  if (arguments.formalism.empty() || arguments.formalism == "line2d")
    throw Failed{input_error("--phi-an", "the formalism line2d has no 1D anisotropy",
                             "Add --formalism line1d or --formalism point, or leave --phi-an out")};
  for (SourceModel& source : sources) {
    source.phi_r_mm = {Tg43::kReference_mm};
    source.phi = {arguments.phi_an};
  }
  return sources;
}

/// @param own_goals whether the program's own goals are judged, which are those of prostate implants: only then does it
///   matter whether the target is a prostate
DoseStructures structures_of(const DoseArguments& arguments, const DosePlan& plan, bool own_goals, Console& console) {
  if (arguments.structures.empty()) return DoseStructures{};
  const auto input = need(read_input(arguments.structures, {}, {}, arguments.skip));
  DoseStructureOptions options;
  options.skip = arguments.skip;
  options.step_mm = arguments.step_mm;
  for (const std::string& argument : arguments.regions) {
    const std::size_t split = argument.rfind('=');
    if (split == std::string::npos || split == 0 || split + 1 == argument.size())
      throw Failed{input_error(fmt::format("--region {}", argument), "NAME=CANONICAL is expected",
                               "Write e.g. --region 'PTV 1=prostate'")};
    options.regions[argument.substr(0, split)] = argument.substr(split + 1);
  }
  auto structures = need(dose_structures(input, options, console.progress()));
  if (own_goals) {
    FitOptions fit;
    fit.names.regions = options.regions;
    fit.names.skip = options.skip;
    for (const FitFinding& finding : judge_fit(input, fit)) structures.notes.push_back(finding.message());
  }
  if (!arguments.ignore_frame && !structures.frame_of_reference.empty() && !plan.frame_of_reference.empty() &&
      structures.frame_of_reference != plan.frame_of_reference) {
    throw Failed{
        input_error(arguments.structures,
                    fmt::format("the structures have the frame of reference {}, the plan has {}",
                                structures.frame_of_reference, plan.frame_of_reference),
                    "Give the structure set of this plan, or add --ignore-frame-of-reference if both have the same "
                    "coordinates nevertheless")};
  }
  return structures;
}

/// The date of the computation, YYYYMMDD.
std::string today() {
  const std::chrono::year_month_day date{std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now())};
  return fmt::format("{:04}{:02}{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

std::string value_text(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

std::string figures_text(const DoseEvaluation& e) {
  const bool is_rate = e.quantity.find("rate") != std::string::npos;
  const auto figure = [&](const char* name) { return fmt::format("{} [{}]", name, is_rate ? "Gy/h" : "Gy"); };
  Table table({"structure", "taken as", "volume [cc]", figure("D90"), figure("D30"), figure("D10"), figure("D2cc"),
               figure("D0.1cc"), "V100 [%]", "V150 [%]", "V200 [%]"});
  const double p = e.prescription_Gy;
  for (const StructureDose& s : e.structures) {
    const auto volume = [&](double share) { return p > 0 ? value_text(s.dvh.percent_above(share * p), 1) : "-"; };
    table.row({s.name, s.region.empty() ? "-" : s.region, value_text(s.dvh.volume_cc(), 2),
               value_text(s.dvh.dose_of_percent(90), 2), value_text(s.dvh.dose_of_percent(30), 2),
               value_text(s.dvh.dose_of_percent(10), 2), value_text(s.dvh.dose_of_volume(2), 2),
               value_text(s.dvh.dose_of_volume(0.1), 2), volume(1.0), volume(1.5), volume(2.0)});
  }
  return table.text();
}

std::string goals_text(const DoseEvaluation& e) {
  Table table({"goal", "bound", "value", "", "citation"});
  for (const JudgedGoal& g : e.goals) {
    const char* verdict = !g.value ? "not judged" : g.met ? "met" : "MISSED";
    table.row({g.goal.structure + " " + g.goal.metric,
               fmt::format("{} {:g}", g.goal.at_least ? "≥" : "≤", g.goal.bound),
               g.value ? value_text(*g.value, 1) : "-", verdict, g.goal.citation});
  }
  return table.text();
}

void print(const DoseEvaluation& e, Console& console) {
  double strength = 0.0, time = 0.0;
  for (const PlannedSource& s : e.plan.sources) {
    strength += s.strength_U;
    time += s.dwell_s;
  }
  const bool temporary = e.plan.implant == Implant::temporary;
  console.say(fmt::format("{}: {} {}, {}", e.plan.file, e.plan.sources.size(), temporary ? "dwell positions" : "seeds",
                          temporary ? fmt::format("{:.1f} s in all", time) : fmt::format("{:.3f} U in all", strength)));
  std::string models = e.source.name;
  for (const SourceModel& more : e.more_sources) models += ", " + more.name;
  console.say(fmt::format(
      "Source {}, formalism {}, {}; {}", models, to_string(e.formalism),
      e.prescription_Gy > 0 ? fmt::format("prescription {:g} Gy", e.prescription_Gy) : std::string("no prescription"),
      e.quantity));
  console.say(patient_sentence(e.patient));
  if (const std::string dates = strength_sentence(e.strength); !dates.empty() && !strength_is_in_doubt(e.strength))
    console.say(dates);  // dates in doubt are among the warnings
  if (!e.structures.empty()) console.say(figures_text(e));
  for (const std::string& reason : figures_left_out(e.structures)) console.say(reason);
  if (!e.goals.empty() && !e.structures.empty() && e.prescription_Gy > 0) console.say(goals_text(e));
  if (e.comparison) {
    console.say(fmt::format("Compared with {}: median ratio {:.4f}, 1st percentile {:.4f}, 99th {:.4f} ({} points)",
                            e.comparison->file, e.comparison->median_ratio, e.comparison->p1, e.comparison->p99,
                            e.comparison->points));
    if (const auto& gamma = e.comparison->gamma) {
      console.say(
          fmt::format("Gamma {:g} %/{:g} mm: {:.1f} % of {} points pass locally, {:.1f} % globally (of {:g} Gy)",
                      gamma->criteria.dose_percent, gamma->criteria.distance_mm, gamma->local_percent, gamma->points,
                      gamma->global_percent, gamma->global_Gy));
    }
  }
}

/// The files that the dose was computed from.
std::vector<DoseInput> inputs_of(const DoseArguments& arguments) {
  std::vector<std::pair<std::string, std::string>> files{{"plan", arguments.plan},
                                                         {"structures", arguments.structures}};
  for (const std::string& source : arguments.sources)
    files.emplace_back("source model", source.substr(source.find('=') + 1));
  files.insert(files.end(),
               {{"compared dose", arguments.compare}, {"points", arguments.points}, {"goals", arguments.goals}});
  return dose_inputs(files);
}

Result<> run_dose(const DoseArguments& arguments, Console& console) {
  need(check_output_folder(arguments.output));
  auto plan = need(read_plan(arguments.plan));
  plan.says.today = today();
  const auto sources = sources_of(arguments, plan);
  auto options = options_of(arguments, plan);
  options.more_sources.assign(sources.begin() + 1, sources.end());
  const auto structures =
      structures_of(arguments, plan, arguments.goals.empty() && plan.implant == Implant::permanent, console);
  const std::string& frame = plan.frame_of_reference.empty() ? structures.frame_of_reference : plan.frame_of_reference;
  const auto patient = need(patient_of({{arguments.plan, arguments.structures, arguments.compare},
                                        arguments.patient_from,
                                        frame,
                                        arguments.ignore_frame}));
  auto e = need(evaluate_dose(plan, sources.front(), structures.structures, options, console.progress()));
  e.warnings.insert(e.warnings.end(), structures.notes.begin(), structures.notes.end());
  e.warnings.insert(e.warnings.end(), plan.notes.begin(), plan.notes.end());
  e.warnings.insert(e.warnings.end(), patient.notes.begin(), patient.notes.end());
  e.patient = record_of_files(patient, plan, sources.front());
  e.assumptions.push_back(patient_sentence(patient));
  if (arguments.ignore_frame) e.assumptions.emplace_back("Frames of reference were not compared, as asked.");
  if (arguments.goals.empty() && !options.goals.empty()) {
    e.assumptions.emplace_back(
        "The goals are common ones for permanent prostate implants. Which publication each bound comes from has not "
        "been "
        "checked against its text; give the goals of your own protocol with --goals.");
  }
  if (!arguments.compare.empty()) {
    const auto grid = need(read_rtdose(arguments.compare));
    Vec3 shift = Vec3::Zero();
    for (std::size_t k = 0; k < arguments.compare_shift_mm.size(); ++k)
      shift[static_cast<Eigen::Index>(k)] = arguments.compare_shift_mm[k];
    need(compare_with_grid(e, grid, structures.structures, options, shift));
    if (!shift.isZero())
      e.assumptions.push_back(
          fmt::format("The compared dose grid was moved by ({:g}, {:g}, {:g}) mm.", shift.x(), shift.y(), shift.z()));
    e.warnings.insert(e.warnings.end(), grid.notes.begin(), grid.notes.end());
  }
  if (e.quantity.find("rate") != std::string::npos) {
    e.assumptions.emplace_back(
        "There is no dose.dcm, since DICOM has no unit of a dose rate; dose.nrrd has the rates [Gy/h].");
  }
  e.computed_on = date_and_time();
  e.inputs = inputs_of(arguments);
  for (const std::string& warning : e.warnings) console.warn(warning);
  need(write_dose_results(e, arguments.output, console.progress()));
  print(e, console);
  console.say(fmt::format("{} → {}", arguments.plan, (fs::path(arguments.output) / "report.html").string()));
  return console.write_json(Json::parse(dose_json(e)));
}

[[noreturn]] void print_rules() {
  for (const PlanRule& rule : plan_rules()) {
    std::cout << fmt::format("\n{}\n  bound: {}\n  otherwise: {}\n  reason: {}\n", rule.name, rule.bound, rule.verdict,
                             rule.reason);
  }
  throw CLI::Success();
}

}  // namespace

Command add_dose_command(CLI::App& program) {
  auto arguments = std::make_shared<DoseArguments>();
  CLI::App* app = program.add_subcommand(
      "dose", "Compute the TG-43 dose of a plan, the dose to its structures, and compare it with a dose grid");
  app->add_option("PLAN", arguments->plan, "Plan: DICOM RTPLAN, plan JSON, or CSV of seeds")->required();
  option(app, "--structures", arguments->structures, "FILE",
         "Structures: contours (DICOM RTSTRUCT, contour JSON), label mask or tetrahedral mesh");
  option(app, "--patient-from", arguments->patient_from, "FILE",
         "DICOM file whose patient, study, frame of reference and structure set plan.dcm and dose.dcm get "
         "(default: those of plan and structures, where they agree)");
  repeated_option(
      app, "--source", arguments->sources, "[ID=]NAME|FILE",
      "Source model: a name such as i125_6711, or a JSON file with TG-43 data; no DICOM plan names it. For "
      "one of several kinds of source ID=NAME, with its number in the plan or its isotope; may be repeated");
  option(app, "-o,--output", arguments->output, "OUT",
         "Folder for report.html, dose.json, dvh.csv, dose.nrrd, plan.dcm and dose.dcm")
      ->required();
  option(app, "--formalism", arguments->formalism, "NAME",
         "line2d (default): line source with 2D anisotropy; line1d: line source with 1D anisotropy; point: "
         "point source with 1D anisotropy")
      ->check(one_of({"line2d", "line1d", "point"}));
  option(app, "--phi-an", arguments->phi_an, "X", "Constant 1D anisotropy in place of the source model's")
      ->check(number_between(0.5, 1.5));
  option(app, "--prescription", arguments->prescription_Gy, "GY", "Prescribed dose in Gy (default: the plan's)")
      ->check(number_between(0.01, 10000, "Gy"));
  option(app, "--quantity", arguments->quantity, "NAME",
         "total (default): dose until the sources have decayed; rate: initial dose rate in Gy/h")
      ->check(one_of({"total", "rate"}));
  option(app, "--days", arguments->days, "D", "Dose within this number of days after the implantation")
      ->check(number_between(0.001, 100000, "d"));
  option(app, "--decay-days", arguments->decay_days, "D",
         "Days from the date of the strengths to the implantation, during which the sources decay (default: 0)")
      ->check(number_between(-10000, 10000, "d"));
  option(app, "--compare", arguments->compare, "RTDOSE", "DICOM RTDOSE to compare with");
  option(app, "--compare-shift", arguments->compare_shift_mm, "X Y Z",
         "Move the compared grid by this many mm along x, y and z (LPS)")
      ->expected(3);
  app->add_flag("--compare-anyway", arguments->compare_anyway,
                "Compare with a dose grid that says that it is of another plan or frame of reference, or no physical "
                "dose of a whole plan, or whose doses differ by more than a factor of five");
  option(app, "--points", arguments->points, "FILE",
         "CSV with the columns x_mm, y_mm, z_mm: points whose dose is computed");
  option(app, "--goals", arguments->goals, "FILE",
         "CSV with the columns structure, metric, bound, citation in place of the program's own goals");
  repeated_option(app, "--region", arguments->regions, "NAME=CANONICAL",
                  "Take the structure NAME as CANONICAL, e.g. 'PTV 1=prostate'; may be repeated");
  repeated_option(app, "--skip", arguments->skip, "NAME", "Leave out the structure NAME; may be repeated");
  option(app, "--step", arguments->step_mm, "MM",
         "Distance of the samples of structures in mm (default: 0.5, or 0.25 below 2 cc)")
      ->check(number_between(0.05, 5, "mm"));
  option(app, "--grid", arguments->grid_mm, "MM", "Distance of the points of the dose grid in mm (default: 1)")
      ->check(number_between(0.2, 10, "mm"));
  app->add_flag_callback("--print-rules", print_rules, "Print the rules by which plans are judged, and nothing else")
      ->trigger_on_parse();
  app->add_flag("--ignore-frame-of-reference", arguments->ignore_frame,
                "Take plan and structures to have the same coordinates although their frames of reference differ");
  return {app, [arguments](Console& console) { return run_dose(*arguments, console); }};
}

}  // namespace stylet::cli
