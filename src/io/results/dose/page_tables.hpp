// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"

#include <string>
#include <vector>

/// The parts of the page of `stylet dose` that need no script, as HTML.
namespace stylet::results {

/// The figures that everybody asks for first, as items of a list.
std::string dose_tiles(const DoseEvaluation& evaluation);

/// A dose and what a page calls it, such as "Plan", "Planned", "Delivered".
struct NamedDose {
  std::string name;
  const DoseEvaluation* evaluation = nullptr;  ///< not null
};

/// The goals with what each dose reaches, or a sentence where there are none. @param doses one or more, all with the
/// same goals
std::string goal_table(const std::vector<NamedDose>& doses);

/// The figures of the histograms, a row for each structure and dose. @param doses one or more, all of the same
/// structures @param colours (structures) structure_colours()
std::string dvh_figures(const std::vector<NamedDose>& doses, const std::vector<std::string>& colours);

/// Doses at points and the comparison with a dose grid of a file, as far as there are any.
std::string points_and_comparison(const DoseEvaluation& evaluation);

/// All seeds or dwell positions.
std::string seed_table(const DoseEvaluation& evaluation);

/// Plan and source as pairs of name and value.
std::string plan_facts(const DoseEvaluation& evaluation);

}  // namespace stylet::results
