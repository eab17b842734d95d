// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/implant.hpp"

#include "stylet/dose/evaluate.hpp"
#include "stylet/implant/compensation.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/io/input.hpp"
#include "stylet/patient/dose_structures.hpp"
#include "stylet/patient/patient_mesh.hpp"
#include "stylet/patient/source_choice.hpp"
#include "stylet/phantom/phantom.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet {

namespace {

Result<PatientInput> patient_input(const Scenario& scenario) {
  if (scenario.patient.source == "phantom") return PatientInput(demo_patient());
  return read_input(scenario.patient.source, {.scale = scenario.patient.scale}, {.volume = scenario.patient.volume},
                    scenario.patient.skip);
}

Result<DoseStructures> structures_of(const Scenario& scenario, const DosePlan& plan, const Progress& progress) {
  const Result<PatientInput> input = patient_input(scenario);
  if (!input) return input.error();
  DoseStructureOptions options;
  options.regions = scenario.patient.regions;
  options.skip = scenario.patient.skip;
  Result<DoseStructures> structures = dose_structures(*input, options, progress);
  if (!structures) return structures;
  if (!structures->frame_of_reference.empty() && !plan.frame_of_reference.empty() &&
      structures->frame_of_reference != plan.frame_of_reference) {
    return input_error(plan.file,
                       fmt::format("the plan has the frame of reference {}, the patient's structures have {}",
                                   plan.frame_of_reference, structures->frame_of_reference),
                       "Give the plan of this patient");
  }
  return structures;
}

/// The point about which the gland swells: the centre of the target's samples; without a target, of the seeds.
Vec3 centre_of(const DoseStructures& structures, const DosePlan& plan) {
  Vec3 sum = Vec3::Zero();
  for (const DoseStructure& structure : structures.structures) {
    if (structure.region != "prostate") continue;
    for (const Vec3& x : structure.samples.points) sum += x;
    return sum / static_cast<double>(std::max<std::size_t>(1, structure.samples.points.size()));
  }
  for (const PlannedSource& source : plan.sources) sum += source.at_mm;
  return sum / static_cast<double>(plan.sources.size());
}

Result<DoseOptions> dose_options(const Scenario& scenario, const DoseStructures& structures, const DosePlan& plan) {
  DoseOptions options;
  if (scenario.plan.goals.empty()) {
    const auto own = permanent_prostate_goals();
    options.goals.assign(own.begin(), own.end());
  } else {
    Result<std::vector<DoseGoal>> goals = read_goals(scenario.plan.goals);
    if (!goals) return goals.error();
    options.goals = *std::move(goals);
  }
  const auto& percent = scenario.oedema.swelling_percent;
  options.swelling = {.centre_mm = centre_of(structures, plan),
                      .at_start = Vec3(percent[0], percent[1], percent[2]) / 100.0,
                      .half_life_days = scenario.oedema.half_life_days};
  return options;
}

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

Result<ImplantOutcome> implant(const Scenario& scenario, const std::string& where, const ImplantSettings& settings,
                               const Progress& progress) {
  if (scenario.plan.file.empty()) {
    return input_error(where, "the scenario has no plan",
                       "Name a plan of seeds in it: [plan] and below it file = \"plan.csv\"");
  }
  if (settings.span && scenario.tissue_model.preset != TissuePreset::typical) {
    return input_error(where,
                       "a span is from firm over typical to soft tissue, and the scenario has another tissue.preset",
                       "Leave tissue.preset out, or do not ask for a span");
  }
  const Result<DosePlan> plan = read_plan(scenario.plan.file);
  if (!plan) return plan.error();
  const Result<SourceModel> source = choose_source(scenario.plan.source, *plan);
  if (!source) return source.error();
  ImplantOutcome outcome;
  outcome.scenario = scenario;
  outcome.seed_length_mm = source->outer_length_mm;
  Result<std::vector<NeedleLoad>> needles = load_needles(*plan, outcome.seed_length_mm, scenario.procedure.plug_mm);
  if (!needles) return needles.error();
  order_needles(*needles, scenario.procedure.order);
  const Result<DoseStructures> structures = structures_of(scenario, *plan, progress);
  if (!structures) return structures.error();
  const Result<DoseOptions> options = dose_options(scenario, *structures, *plan);
  if (!options) return options.error();
  const auto dose_of = [&](const ImplantHistory& history) -> Result<DoseEvaluation> {
    const DosePlan delivered = delivered_plan(*plan, history);
    if (delivered.sources.empty())
      return failure(where, "all seeds are lost, so there is no dose", "Lower seed.loss_percent");
    return evaluate_dose(delivered, *source, structures->structures, *options, progress);
  };
  // The dose of the plan comes first: a plan of another patient is found out before minutes are spent on needles.
  DoseOptions without_swelling = *options;
  without_swelling.swelling = {};
  Result<DoseEvaluation> planned = evaluate_dose(*plan, *source, structures->structures, without_swelling, progress);
  if (!planned) return planned.error();
  outcome.planned = *std::move(planned);

  Result<MeshedAnatomy> patient = mesh_patient(scenario, progress);
  if (!patient) return patient.error();
  const auto simulate = [&](const Scenario& s, const std::vector<NeedleLoad>& loads) {
    return simulate_implant(s, patient->mesh, loads, outcome.seed_length_mm, where, progress);
  };
  std::vector<NeedleLoad> aimed = *needles;
  if (settings.compensate > 0) {
    auto done = compensate(*needles, settings.compensate,
                           [&](const std::vector<NeedleLoad>& loads) { return simulate(scenario, loads); });
    if (!done) return done.error();
    auto before = dose_of(done->before);
    if (!before) return before.error();
    outcome.before = OtherImplant{"before compensation", std::move(done->before), *std::move(before)};
    outcome.history = std::move(done->after);
    aimed = std::move(done->needles);
  } else {
    Result<ImplantHistory> history = simulate(scenario, aimed);
    if (!history) return history.error();
    outcome.history = *std::move(history);
  }
  Result<DoseEvaluation> dose = dose_of(outcome.history);
  if (!dose) return dose.error();
  outcome.delivered = *std::move(dose);
  for (const TissuePreset preset : {TissuePreset::firm, TissuePreset::soft}) {
    if (!settings.span) break;
    Scenario other = scenario;
    other.tissue_model.preset = preset;
    Result<ImplantHistory> history = simulate(other, aimed);
    if (!history) return history.error();
    Result<DoseEvaluation> delivered = dose_of(*history);
    if (!delivered) return delivered.error();
    outcome.spans.push_back({"tissue " + word(preset), *std::move(history), *std::move(delivered)});
  }

  append(outcome.warnings, plan->notes);
  append(outcome.warnings, structures->notes);
  append(outcome.warnings, patient->report.notes);
  append(outcome.warnings, outcome.history.warnings);
  append(outcome.warnings, outcome.delivered.warnings);
  return outcome;
}

}  // namespace stylet
