// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/evaluate.hpp"

#include <span>
#include <string>
#include <vector>

/// The rules by which a plan is plausible, whatever format it comes from. `stylet dose --print-rules` prints them.
namespace stylet {

/// One rule. A plan that breaks it is refused where the dose would surely be wrong, and warned of otherwise.
struct PlanRule {
  std::string name;     ///< short name, which stands in the message of a violation
  std::string bound;    ///< the bound that a plausible plan keeps
  std::string verdict;  ///< the fate of a plan that does not keep it: "refused", "warned of" or both with bounds
  std::string reason;   ///< where the bound comes from
};

/// All rules, in the order of the table.
[[nodiscard]] std::span<const PlanRule> plan_rules();

/// Judges a plan before its dose is computed: strengths, isotopes, times, dates, prescription, places.
/// @param models one for each kind of source @param structures may be empty: rules about the target are left out
/// @return sentences of warning, each with the name of its rule
/// Errors: the first rule that refuses.
Result<std::vector<std::string>> judge_plan(const DosePlan& plan, std::span<const SourceModel> models,
                                            std::span<const DoseStructure> structures, const DoseOptions& options);

/// Judges the dose of a plan: that to the target against the prescription.
/// @return sentences of warning
/// Errors: a dose that is surely wrong.
Result<std::vector<std::string>> judge_dose(const DoseEvaluation& evaluation);

}  // namespace stylet
