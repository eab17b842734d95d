// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/dose/dose_evaluation.hpp"
#include "stylet/dose/dose_over_time.hpp"
#include "stylet/implant/found_errors.hpp"
#include "stylet/probe/patient_probe.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// An implant that another choice would have given, for comparison.
struct OtherImplant {
  std::string name;  ///< "before compensation", "tissue firm", …
  ImplantHistory history;
  DoseEvaluation delivered;
};

/// The seeds that were found on images after the implant, beside those of the simulation.
struct FoundImplant {
  FoundSeeds seeds;
  FoundComparison comparison;
  DoseEvaluation dose;                ///< of all seeds where they were found, otherwise as the delivered dose
  DoseEvaluation dose_without_shift;  ///< the same on a coarse grid, after the common shift is taken away
};

/// An implant as it was planned and as it was delivered: everything that the result folder of `stylet implant` says.
struct ImplantOutcome {
  Scenario scenario;
  TetMesh mesh;  ///< of the patient, at rest
  ImplantHistory history;
  DoseEvaluation planned;            ///< dose of the plan
  DoseEvaluation delivered;          ///< dose of the seeds where they have come to rest
  std::optional<ProbeReport> probe;  ///< that pressed while seeds were dropped; empty: none did
  /// Dose of the same seeds to the same tissue once the probe is out, where the contours were drawn with the probe in
  /// place. Otherwise the delivered dose is that without a probe.
  std::optional<DoseEvaluation> probe_out;
  std::optional<DoseCourse> oedema;  ///< D90 of the target over time, where the gland swells
  double seed_length_mm = 0.0;
  std::optional<OtherImplant> before;  ///< without compensation, where the needles were aimed to make up for the errors
  /// A temporary implant as the images of the plan show it, before the wait until the delivery.
  std::optional<OtherImplant> at_planning;
  std::vector<OtherImplant> spans;    ///< with firmer and softer tissue, where they were asked for
  std::optional<FoundImplant> found;  ///< where seeds that were found are given
  std::vector<std::string> warnings;  ///< of reader, mesher, plan and simulation
};

/// Writes the result folder of `stylet implant` (docs/results): report.html, seeds.csv, run.h5, the folders planned
/// and delivered with all files of `stylet dose`, and summary.json last; with found seeds also found.csv and the folder
/// found. Without them, a found.csv of an earlier run is removed, and so is the dose.json that marks its folder as
/// complete. Errors: the folder cannot be created or written.
Result<> write_implant_results(const ImplantOutcome& outcome, const std::filesystem::path& folder,
                               const Progress& progress = {});

/// The text of summary.json (docs/results).
std::string implant_json(const ImplantOutcome& outcome);

/// The text of seeds.csv (docs/results): a row for each seed of the plan.
std::string seeds_csv(const ImplantOutcome& outcome);

/// The text of found.csv (docs/results): a row for each seed of the plan, with the place where it was found, and for
/// each seed that was found without a match.
/// @param history the simulated implant, of which `found` is the comparison
std::string found_csv(const ImplantHistory& history, const FoundImplant& found);

/// Sentences about the match of the found seeds: which seeds have no match, which matches are ambiguous, the
/// common shift and whether it is more than chance, and how much the simulation explains.
/// @param history the simulated implant, of which `found` is the comparison
std::vector<std::string> found_sentences(const ImplantHistory& history, const FoundImplant& found);

}  // namespace stylet
