// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/dose/dose_evaluation.hpp"
#include "stylet/implant/seed_errors.hpp"

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

/// An implant as it was planned and as it was delivered: everything that the result folder of `stylet implant` says.
struct ImplantOutcome {
  Scenario scenario;
  ImplantHistory history;
  DoseEvaluation planned;    ///< dose of the plan
  DoseEvaluation delivered;  ///< dose of the seeds where they have come to rest
  double seed_length_mm = 0.0;
  std::optional<OtherImplant> before;  ///< without compensation, where the needles were aimed to make up for the errors
  std::vector<OtherImplant> spans;     ///< with firmer and softer tissue, where they were asked for
  std::vector<std::string> warnings;   ///< of reader, mesher, plan and simulation
};

/// Writes the result folder of `stylet implant` (docs/results.md): report.html, seeds.csv, the folders planned and
/// delivered with all files of `stylet dose`, and summary.json last. Errors: the folder cannot be created or written.
Result<> write_implant_results(const ImplantOutcome& outcome, const std::filesystem::path& folder,
                               const Progress& progress = {});

/// The text of summary.json (docs/results.md).
std::string implant_json(const ImplantOutcome& outcome);

/// The text of seeds.csv (docs/results.md): a row for each seed of the plan.
std::string seeds_csv(const ImplantOutcome& outcome);

}  // namespace stylet
