// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/implant.hpp"

#include "implant_probe.hpp"
#include "stylet/dose/evaluate.hpp"
#include "stylet/implant/compensation.hpp"
#include "stylet/implant/displaced_tissue.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/io/found_seeds_io.hpp"
#include "stylet/io/patient_record_io.hpp"
#include "stylet/patient/implant_plan.hpp"
#include "stylet/patient/patient_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet {

namespace {

/// A grid that nobody sees is this many times as coarse, so that it takes hardly any time.
constexpr double kGridNotShown = 10.0;

/// The seeds that were found, checked; nothing where no file is named.
Result<std::optional<FoundSeeds>> found_seeds_of(const ImplantSettings& settings, const DosePlan& plan) {
  if (settings.found.empty()) return std::optional<FoundSeeds>();
  if (settings.compensate > 0) {
    return input_error(settings.found.string(),
                       "found seeds are compared with the implant as it is planned, and compensation changes that",
                       "Leave out either the found seeds or compensation");
  }
  Result<FoundSeeds> found = read_found_seeds(settings.found);
  if (!found) return found.error();
  if (Result<> fits = check_found_seeds(*found, plan); !fits) return fits.error();
  if (!found->frame_of_reference.empty() && !plan.frame_of_reference.empty() &&
      found->frame_of_reference != plan.frame_of_reference) {
    found->notes.push_back(
        fmt::format("{} has another frame of reference than the plan; its places are taken as they are. If they were "
                    "not registered to the plan, the common shift is that of the frames.",
                    found->file));
  }
  return std::optional<FoundSeeds>(*std::move(found));
}

/// Warnings about the match, which a user needs before believing the figures that depend on it.
std::vector<std::string> match_warnings(const FoundImplant& found) {
  std::vector<std::string> warnings;
  const SeedMatching& matching = found.comparison.matching;
  const std::string& file = found.seeds.file;
  if (matching.pairs.empty()) {
    warnings.push_back(fmt::format("No seed of {} lies within {:g} mm of a simulated seed, so none is matched.", file,
                                   kMatchLimit_mm));
  }
  if (matching.frame_moved) {
    warnings.push_back(
        fmt::format("The seeds of {} match those of the simulation only after a common shift of {:.1f} mm: their frame "
                    "does not seem to be that of the plan. Register the images to the plan first.",
                    file, matching.shift_mm.norm()));
  }
  const std::size_t matched = found.comparison.seeds.size();
  const auto ambiguous =
      std::count_if(matching.pairs.begin(), matching.pairs.end(), [](const SeedPair& pair) { return pair.ambiguous; });
  if (4 * static_cast<std::size_t>(ambiguous) > matched) {
    warnings.push_back(
        fmt::format("{} of {} matches of found seeds are ambiguous: the found seeds scatter by {:.1f} mm along each "
                    "axis, so errors of single seeds, and what the simulation explains, are less sure.",
                    ambiguous, matched, matching.scatter_mm));
  }
  return warnings;
}

/// The D90 of the target while the gland swells; nothing where it does not swell or where there is no target.
Result<std::optional<DoseCourse>> course_of_oedema(const ImplantPlan& of, const DosePlan& delivered) {
  const auto& structures = of.structures.structures;
  const auto target = std::find_if(structures.begin(), structures.end(),
                                   [](const DoseStructure& structure) { return structure.region == "prostate"; });
  if (!of.options.swelling.is_any() || delivered.implant != Implant::permanent || target == structures.end())
    return std::optional<DoseCourse>();
  Result<DoseCourse> course = d90_over_time(delivered, of.source, target->samples, of.options);
  if (!course) return course.error();
  return std::optional<DoseCourse>(*std::move(course));
}

/// Only the implant that the results are about keeps the steps of its needles; other choices would multiply the memory.
ImplantHistory without_records(ImplantHistory history) {
  for (std::vector<NeedleHistory>* needles : {&history.needles, &history.stabilising}) {
    for (NeedleHistory& needle : *needles) needle.record = {};
  }
  return history;
}

/// Refuses settings that only permanent implants have, where the plan is a temporary implant.
Result<> check_temporary_settings(const ImplantSettings& settings, const DosePlan& plan) {
  if (settings.compensate > 0) {
    return input_error(plan.file,
                       fmt::format("the plan is a temporary implant, and compensation ({} rounds) aims needles so that "
                                   "their seeds come to rest where they were planned; catheters are planned where they "
                                   "are found on images",
                                   settings.compensate),
                       "Leave compensation out");
  }
  if (!settings.found.empty()) {
    return input_error(
        settings.found.string(),
        "found seeds are compared with seeds that rest, and the plan is a temporary implant, " + plan.file,
        "Leave the found seeds out");
  }
  return Ok{};
}

/// The dose once the probe is out, where the contours were drawn with the probe in place: gland and seeds go back.
Result<std::optional<DoseEvaluation>> dose_without_probe(const ImplantPlan& of, const DosePlan& delivered,
                                                         const std::optional<ImplantProbe>& probe,
                                                         const Progress& progress) {
  if (!probe || !probe->report.settings.in_contours) return std::optional<DoseEvaluation>();
  const Locator& locator = *probe->patient.locator;
  std::vector<DoseStructure> structures;
  for (const DoseStructure& structure : of.structures.structures)
    structures.push_back(displaced(locator, probe->out, structure));
  DoseOptions options = of.options;  // only histograms and goals are shown, which do not need the grid
  options.grid_step_mm *= kGridNotShown;
  Result<DoseEvaluation> dose = evaluate_dose(displaced(locator, probe->out, of.source.outer_length_mm, delivered),
                                              of.source, structures, options, progress);
  if (!dose) return dose.error();
  return std::optional<DoseEvaluation>(*std::move(dose));
}

/// Sentences that say where the figures of the implant leave the scenario's probe out.
std::vector<std::string> probe_warnings(const Scenario& scenario, const ImplantPlan& of, bool found) {
  if (scenario.probe.kind == ProbeKind::none) return {};
  if (of.plan.implant == Implant::temporary)
    return {
        "The probe of the scenario does not move the dwell positions: it is taken to be out when the images of the "
        "plan are taken and at the delivery."};
  if (found && scenario.probe.in_contours)
    return {
        "The seeds found on images are compared with those in the contours, which were drawn with the probe in "
        "place. If the images were taken without a probe, part of the difference is the way that gland and seeds "
        "go when the probe is taken out."};
  return {};
}

/// Whose implant it is, as the files of plan, patient and found seeds say.
Result<FoundPatient> patient_of_implant(const Scenario& scenario, const ImplantPlan& of,
                                        const ImplantSettings& settings) {
  const std::string& source = scenario.patient.source;
  PatientInputs inputs{.files = {scenario.plan.file, source == "phantom" ? "" : source, settings.found},
                       .chosen = settings.patient_from,
                       .frame_of_reference = of.plan.frame_of_reference};
  if (inputs.frame_of_reference.empty()) inputs.frame_of_reference = of.structures.frame_of_reference;
  return patient_of(inputs);
}

/// Adds the sentences that are not there yet: mesh and dose say the same of contours.
void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  for (const std::string& sentence : more) {
    if (std::find(all.begin(), all.end(), sentence) == all.end()) all.push_back(sentence);
  }
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
  if (of.plan.implant == Implant::temporary) {
    if (Result<> possible = check_temporary_settings(settings, of.plan); !possible) return possible.error();
  }
  Result<std::optional<FoundSeeds>> found_seeds = found_seeds_of(settings, of.plan);
  if (!found_seeds) return found_seeds.error();
  const Result<FoundPatient> whose = patient_of_implant(scenario, of, settings);
  if (!whose) return whose.error();
  const auto write_patient = [record = record_of_files(*whose, of.plan, of.source), &whose](DoseEvaluation& dose) {
    dose.patient = record;
    dose.assumptions.push_back(patient_sentence(*whose));
  };
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
  // The needles go through the tissue as it is in the contours; the displacement by the probe comes on top of theirs.
  const auto probe_in = [&](const Scenario& s) -> Result<std::optional<ImplantProbe>> {
    if (of.plan.implant == Implant::temporary) return std::optional<ImplantProbe>();
    return implant_probe(s, patient->mesh, where, progress);
  };
  Result<std::optional<ImplantProbe>> probe = probe_in(scenario);
  if (!probe) return probe.error();
  if (*probe) outcome.probe = (*probe)->report;
  const auto simulate = [&](const Scenario& s, const std::optional<ImplantProbe>& pressing,
                            const std::vector<NeedleLoad>& loads) {
    Result<ImplantHistory> history = simulate_implant(s, patient->mesh, loads, outcome.seed_length_mm, where, progress);
    if (history && pressing && !s.probe.in_contours)
      let_tissue_go_back(*pressing->patient.locator, pressing->in, outcome.seed_length_mm, history->seeds);
    return history;
  };
  std::vector<NeedleLoad> aimed = of.needles;
  if (settings.compensate > 0) {
    auto done = compensate(of.needles, settings.compensate,
                           [&](const std::vector<NeedleLoad>& loads) { return simulate(scenario, *probe, loads); });
    if (!done) return done.error();
    auto before = dose_of(done->before);
    if (!before) return before.error();
    outcome.before = OtherImplant{"before compensation", without_records(std::move(done->before)), *std::move(before)};
    outcome.history = std::move(done->after);
    aimed = std::move(done->needles);
  } else {
    Result<ImplantHistory> history = simulate(scenario, *probe, aimed);
    if (!history) return history.error();
    outcome.history = *std::move(history);
  }
  Result<DoseEvaluation> dose = dose_of(outcome.history);
  if (!dose) return dose.error();
  outcome.delivered = *std::move(dose);
  Result<std::optional<DoseEvaluation>> probe_out = dose_without_probe(of, outcome.delivered.plan, *probe, progress);
  if (!probe_out) return probe_out.error();
  outcome.probe_out = *std::move(probe_out);
  Result<std::optional<DoseCourse>> oedema = course_of_oedema(of, outcome.delivered.plan);
  if (!oedema) return oedema.error();
  outcome.oedema = *std::move(oedema);
  if (of.plan.implant == Implant::temporary) {
    ImplantHistory then = history_at_planning(outcome.history);
    // Only histograms and goals of this dose are shown, which do not need its grid.
    DoseOptions at_planning = of.options;
    at_planning.grid_step_mm *= kGridNotShown;
    Result<DoseEvaluation> seen =
        evaluate_dose(delivered_plan(of.plan, then), of.source, of.structures.structures, at_planning, progress);
    if (!seen) return seen.error();
    outcome.at_planning = OtherImplant{"at planning", std::move(then), *std::move(seen)};
  }
  for (const TissuePreset preset : {TissuePreset::firm, TissuePreset::soft}) {
    if (!settings.span) break;
    Scenario other = scenario;
    other.tissue_model.preset = preset;
    const Result<std::optional<ImplantProbe>> other_probe = probe_in(other);
    if (!other_probe) return other_probe.error();
    Result<ImplantHistory> history = simulate(other, *other_probe, aimed);
    if (!history) return history.error();
    Result<DoseEvaluation> delivered = dose_of(*history);
    if (!delivered) return delivered.error();
    outcome.spans.push_back({"tissue " + word(preset), without_records(*std::move(history)), *std::move(delivered)});
  }

  if (*found_seeds) {
    FoundImplant found{.seeds = **std::move(found_seeds)};
    found.comparison = compare_found(outcome.history, found.seeds.seeds);
    const auto found_dose = [&](const Vec3& shift_mm, double grid_step_mm) {
      DoseOptions of_found = of.options;
      of_found.grid_step_mm = grid_step_mm;
      return evaluate_dose(found_plan(of.plan, outcome.history, found.seeds.seeds, found.comparison, shift_mm),
                           of.source, of.structures.structures, of_found, progress);
    };
    Result<DoseEvaluation> as_found = found_dose(Vec3::Zero(), of.options.grid_step_mm);
    if (!as_found) return as_found.error();
    found.dose = *std::move(as_found);
    // Only histograms and goals of this dose are shown, which do not need its grid.
    Result<DoseEvaluation> without_shift =
        found_dose(found.comparison.matching.shift_mm, kGridNotShown * of.options.grid_step_mm);
    if (!without_shift) return without_shift.error();
    found.dose_without_shift = *std::move(without_shift);
    append(outcome.warnings, found.seeds.notes);
    append(outcome.warnings, match_warnings(found));
    outcome.found = std::move(found);
  }

  write_patient(outcome.planned);
  write_patient(outcome.delivered);
  if (outcome.found) write_patient(outcome.found->dose);
  append(outcome.warnings, whose->notes);
  outcome.mesh = std::move(patient->mesh);
  append(outcome.warnings, of.plan.notes);
  append(outcome.warnings, of.structures.notes);
  append(outcome.warnings, patient->report.notes);
  if (*probe) append(outcome.warnings, probe_harms(**probe, outcome.history));
  append(outcome.warnings, probe_warnings(scenario, of, outcome.found.has_value()));
  append(outcome.warnings, outcome.history.warnings);
  append(outcome.warnings, outcome.delivered.warnings);
  return outcome;
}

}  // namespace stylet
