// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/implant.hpp"

#include "stylet/dose/evaluate.hpp"
#include "stylet/implant/compensation.hpp"
#include "stylet/patient/implant_plan.hpp"
#include "stylet/patient/patient_mesh.hpp"

namespace stylet {

namespace {

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

Result<ImplantOutcome> implant(const Scenario& scenario, const std::string& where, const ImplantSettings& settings,
                               const Progress& progress) {
  if (settings.span && scenario.tissue_model.preset != TissuePreset::typical) {
    return input_error(where,
                       "a span is from firm over typical to soft tissue, and the scenario has another tissue.preset",
                       "Leave tissue.preset out, or do not ask for a span");
  }
  Result<ImplantPlan> read = read_implant_plan(scenario, where, progress);
  if (!read) return read.error();
  const ImplantPlan& of = *read;
  ImplantOutcome outcome;
  outcome.scenario = scenario;
  outcome.seed_length_mm = of.source.outer_length_mm;
  const auto dose_of = [&](const ImplantHistory& history) -> Result<DoseEvaluation> {
    const DosePlan delivered = delivered_plan(of.plan, history);
    if (delivered.sources.empty())
      return failure(where, "all seeds are lost, so there is no dose", "Lower seed.loss_percent");
    return evaluate_dose(delivered, of.source, of.structures.structures, of.options, progress);
  };
  // The dose of the plan comes first: a plan of another patient is found out before minutes are spent on needles.
  DoseOptions without_swelling = of.options;
  without_swelling.swelling = {};
  Result<DoseEvaluation> planned =
      evaluate_dose(of.plan, of.source, of.structures.structures, without_swelling, progress);
  if (!planned) return planned.error();
  outcome.planned = *std::move(planned);

  Result<MeshedAnatomy> patient = mesh_patient(scenario, progress);
  if (!patient) return patient.error();
  const auto simulate = [&](const Scenario& s, const std::vector<NeedleLoad>& loads) {
    return simulate_implant(s, patient->mesh, loads, outcome.seed_length_mm, where, progress);
  };
  std::vector<NeedleLoad> aimed = of.needles;
  if (settings.compensate > 0) {
    auto done = compensate(of.needles, settings.compensate,
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

  append(outcome.warnings, of.plan.notes);
  append(outcome.warnings, of.structures.notes);
  append(outcome.warnings, patient->report.notes);
  append(outcome.warnings, outcome.history.warnings);
  append(outcome.warnings, outcome.delivered.warnings);
  return outcome;
}

}  // namespace stylet
