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

/// An implant from its plan to its figures, stage by stage. Each stage adds to the outcome or fails.
class ImplantStages {
 public:
  ImplantStages(const Scenario& scenario, const std::string& where, const ImplantSettings& settings,
                const Progress& progress)
      : scenario_(scenario), where_(where), settings_(settings), progress_(progress) {}

  Result<ImplantOutcome> run();

 private:
  Result<> read();
  Result<> dose_of_plan();
  Result<> mesh();
  Result<> simulate();
  Result<> delivered_dose();
  Result<> dose_at_planning();
  Result<> other_tissue();
  Result<> compare_with_found();
  void collect_words();

  [[nodiscard]] bool is_temporary() const { return of_->plan.implant == Implant::temporary; }
  /// The needles go through the tissue as it is in the contours; the displacement by the probe comes on top of theirs.
  [[nodiscard]] Result<std::optional<ImplantProbe>> probe_in(const Scenario& scenario) const;
  [[nodiscard]] Result<ImplantHistory> history_of(const Scenario& scenario, const std::optional<ImplantProbe>& pressing,
                                                  const std::vector<NeedleLoad>& loads) const;
  [[nodiscard]] Result<DoseEvaluation> dose_of(const DosePlan& plan, const DoseOptions& options) const {
    return evaluate_dose(plan, of_->source, of_->structures.structures, options, progress_);
  }
  [[nodiscard]] Result<DoseEvaluation> dose_of(const ImplantHistory& history) const;
  /// Options for a dose of which only histograms and goals are shown, which do not need its grid.
  [[nodiscard]] DoseOptions without_grid() const;

  const Scenario& scenario_;
  const std::string& where_;
  const ImplantSettings& settings_;
  const Progress& progress_;
  std::optional<ImplantPlan> of_;  ///< there after read()
  std::optional<FoundSeeds> found_seeds_;
  FoundPatient whose_;
  MeshedAnatomy patient_;
  std::optional<ImplantProbe> probe_;
  std::vector<NeedleLoad> aimed_;  ///< needles as they are inserted: as planned, or compensated
  ImplantOutcome outcome_;
};

Result<> ImplantStages::read() {
  if (settings_.span && scenario_.tissue_model.preset != TissuePreset::typical) {
    return input_error(where_,
                       "a span is from firm over typical to soft tissue, and the scenario has another tissue.preset",
                       "Leave tissue.preset out, or do not ask for a span");
  }
  Result<ImplantPlan> read = read_implant_plan(scenario_, where_, progress_);
  if (!read) return read.error();
  of_ = *std::move(read);
  if (is_temporary()) {
    if (Result<> possible = check_temporary_settings(settings_, of_->plan); !possible) return possible.error();
  }
  Result<std::optional<FoundSeeds>> found = found_seeds_of(settings_, of_->plan);
  if (!found) return found.error();
  found_seeds_ = *std::move(found);
  Result<FoundPatient> whose = patient_of_implant(scenario_, *of_, settings_);
  if (!whose) return whose.error();
  whose_ = *std::move(whose);
  outcome_.scenario = scenario_;
  outcome_.seed_length_mm = of_->source.outer_length_mm;
  return Ok{};
}

/// It comes first: a plan of another patient is found out before minutes are spent on needles.
Result<> ImplantStages::dose_of_plan() {
  DoseOptions without_swelling = of_->options;
  without_swelling.swelling = {};
  Result<DoseEvaluation> planned = dose_of(of_->plan, without_swelling);
  if (!planned) return planned.error();
  outcome_.planned = *std::move(planned);
  return Ok{};
}

Result<> ImplantStages::mesh() {
  Result<MeshedAnatomy> patient = mesh_patient(scenario_, progress_);
  if (!patient) return patient.error();
  patient_ = *std::move(patient);
  Result<std::optional<ImplantProbe>> probe = probe_in(scenario_);
  if (!probe) return probe.error();
  probe_ = *std::move(probe);
  if (probe_) outcome_.probe = probe_->report;
  return Ok{};
}

Result<std::optional<ImplantProbe>> ImplantStages::probe_in(const Scenario& scenario) const {
  if (is_temporary()) return std::optional<ImplantProbe>();
  return implant_probe(scenario, patient_.mesh, where_, progress_);
}

Result<ImplantHistory> ImplantStages::history_of(const Scenario& scenario, const std::optional<ImplantProbe>& pressing,
                                                 const std::vector<NeedleLoad>& loads) const {
  Result<ImplantHistory> history =
      simulate_implant(scenario, patient_.mesh, loads, outcome_.seed_length_mm, where_, progress_);
  if (history && pressing && !scenario.probe.in_contours)
    let_tissue_go_back(*pressing->patient.locator, pressing->in, outcome_.seed_length_mm, history->seeds);
  return history;
}

Result<DoseEvaluation> ImplantStages::dose_of(const ImplantHistory& history) const {
  const DosePlan delivered = delivered_plan(of_->plan, history);
  if (delivered.sources.empty())
    return failure(where_, "all seeds are lost, so there is no dose", "Lower seed.loss_percent");
  return dose_of(delivered, of_->options);
}

DoseOptions ImplantStages::without_grid() const {
  DoseOptions options = of_->options;
  options.grid_step_mm *= kGridNotShown;
  return options;
}

Result<> ImplantStages::simulate() {
  aimed_ = of_->needles;
  if (settings_.compensate == 0) {
    Result<ImplantHistory> history = history_of(scenario_, probe_, aimed_);
    if (!history) return history.error();
    outcome_.history = *std::move(history);
    return Ok{};
  }
  auto done = compensate(of_->needles, settings_.compensate,
                         [&](const std::vector<NeedleLoad>& loads) { return history_of(scenario_, probe_, loads); });
  if (!done) return done.error();
  auto before = dose_of(done->before);
  if (!before) return before.error();
  outcome_.before = OtherImplant{"before compensation", without_records(std::move(done->before)), *std::move(before)};
  outcome_.history = std::move(done->after);
  aimed_ = std::move(done->needles);
  return Ok{};
}

Result<> ImplantStages::delivered_dose() {
  Result<DoseEvaluation> dose = dose_of(outcome_.history);
  if (!dose) return dose.error();
  outcome_.delivered = *std::move(dose);
  Result<std::optional<DoseEvaluation>> probe_out =
      dose_without_probe(*of_, outcome_.delivered.plan, probe_, progress_);
  if (!probe_out) return probe_out.error();
  outcome_.probe_out = *std::move(probe_out);
  Result<std::optional<DoseCourse>> oedema = course_of_oedema(*of_, outcome_.delivered.plan);
  if (!oedema) return oedema.error();
  outcome_.oedema = *std::move(oedema);
  return Ok{};
}

Result<> ImplantStages::dose_at_planning() {
  if (!is_temporary()) return Ok{};
  ImplantHistory then = history_at_planning(outcome_.history);
  Result<DoseEvaluation> seen = dose_of(delivered_plan(of_->plan, then), without_grid());
  if (!seen) return seen.error();
  outcome_.at_planning = OtherImplant{"at planning", std::move(then), *std::move(seen)};
  return Ok{};
}

Result<> ImplantStages::other_tissue() {
  if (!settings_.span) return Ok{};
  for (const TissuePreset preset : {TissuePreset::firm, TissuePreset::soft}) {
    Scenario other = scenario_;
    other.tissue_model.preset = preset;
    const Result<std::optional<ImplantProbe>> pressing = probe_in(other);
    if (!pressing) return pressing.error();
    Result<ImplantHistory> history = history_of(other, *pressing, aimed_);
    if (!history) return history.error();
    Result<DoseEvaluation> delivered = dose_of(*history);
    if (!delivered) return delivered.error();
    outcome_.spans.push_back({"tissue " + word(preset), without_records(*std::move(history)), *std::move(delivered)});
  }
  return Ok{};
}

Result<> ImplantStages::compare_with_found() {
  if (!found_seeds_) return Ok{};
  FoundImplant found{.seeds = *std::move(found_seeds_)};
  found.comparison = compare_found(outcome_.history, found.seeds.seeds);
  const auto found_dose = [&](const Vec3& shift_mm, const DoseOptions& options) {
    return dose_of(found_plan(of_->plan, outcome_.history, found.seeds.seeds, found.comparison, shift_mm), options);
  };
  Result<DoseEvaluation> as_found = found_dose(Vec3::Zero(), of_->options);
  if (!as_found) return as_found.error();
  found.dose = *std::move(as_found);
  Result<DoseEvaluation> without_shift = found_dose(found.comparison.matching.shift_mm, without_grid());
  if (!without_shift) return without_shift.error();
  found.dose_without_shift = *std::move(without_shift);
  append(outcome_.warnings, found.seeds.notes);
  append(outcome_.warnings, match_warnings(found));
  outcome_.found = std::move(found);
  return Ok{};
}

/// Writes whose implant it is into the doses, and collects all that a user should know.
void ImplantStages::collect_words() {
  const PatientRecord record = record_of_files(whose_, of_->plan, of_->source);
  const auto write_patient = [&](DoseEvaluation& dose) {
    dose.patient = record;
    dose.assumptions.push_back(patient_sentence(whose_));
  };
  write_patient(outcome_.planned);
  write_patient(outcome_.delivered);
  if (outcome_.found) write_patient(outcome_.found->dose);
  append(outcome_.warnings, whose_.notes);
  append(outcome_.warnings, of_->plan.notes);
  append(outcome_.warnings, of_->structures.notes);
  append(outcome_.warnings, patient_.report.notes);
  if (probe_) append(outcome_.warnings, probe_harms(*probe_, outcome_.history));
  append(outcome_.warnings, probe_warnings(scenario_, *of_, outcome_.found.has_value()));
  append(outcome_.warnings, outcome_.history.warnings);
  append(outcome_.warnings, outcome_.delivered.warnings);
}

Result<ImplantOutcome> ImplantStages::run() {
  for (auto stage : {&ImplantStages::read, &ImplantStages::dose_of_plan, &ImplantStages::mesh, &ImplantStages::simulate,
                     &ImplantStages::delivered_dose, &ImplantStages::dose_at_planning, &ImplantStages::other_tissue,
                     &ImplantStages::compare_with_found}) {
    if (Result<> done = (this->*stage)(); !done) return done.error();
  }
  collect_words();
  outcome_.mesh = std::move(patient_.mesh);
  return std::move(outcome_);
}

}  // namespace

Result<ImplantOutcome> implant(const Scenario& scenario, const std::string& where, const ImplantSettings& settings,
                               const Progress& progress) {
  return ImplantStages(scenario, where, settings, progress).run();
}

}  // namespace stylet
