// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/dose/dose_volume.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// One goal of planning: a figure of a structure's dose–volume histogram and the bound that it should keep.
struct DoseGoal {
  std::string structure;  ///< region, such as "prostate" (the target), "urethra", "rectum", "bladder"
  std::string metric;     ///< figure with its unit, such as "D90_percent", "V150_percent", "D2cc_Gy", "V100_cc"
  bool at_least = true;   ///< whether the figure should be at least the bound, or at most
  double bound = 0.0;     ///< [unit of the metric]
  std::string citation;   ///< publication or protocol of the goal
};

/// A figure of a dose–volume histogram, parsed from its name: D90_Gy, D90_percent, D2cc_Gy, D0.1cc_percent,
/// V100_percent, V150_cc. "D…_percent" is in percent of the prescribed dose.
struct DoseMetric {
  enum class Kind { dose_of_percent, dose_of_cc, volume } kind = Kind::dose_of_percent;
  double amount = 0.0;  ///< D90: 90 %; D2cc: 2 cc; V150: 150 % of the prescribed dose
  enum class Unit { Gy, percent, cc } unit = Unit::Gy;
};

/// Parses the name of a figure. Error: the text is none; the message lists examples.
/// @param where place of the text for the message
Result<DoseMetric> parse_metric(const std::string& text, const std::string& where);

/// A goal as text, in the words of a table of goals.
struct GoalText {
  std::string structure, metric, bound, citation;
};

/// Parses a goal. The bound itself meets the goal, with "=" or without. Errors: no structure; a metric that
/// parse_metric() refuses; a bound that is not > or <, perhaps with
/// =, and a number. @param where place of the goal for the message
Result<DoseGoal> parse_goal(const GoalText& text, const std::string& where);

/// The value of a figure of a histogram [unit of the figure]; empty if it needs a prescribed dose and there is none, or
/// more volume than the structure has.
/// @param prescription_Gy prescribed dose [Gy]; 0: none is known
[[nodiscard]] std::optional<double> figure_of(const DoseMetric& metric, const DoseVolume& dvh, double prescription_Gy);

/// Whether a value keeps the bound of a goal; the bound itself does.
[[nodiscard]] bool meets(const DoseGoal& goal, double value);

/// The program's own goals for permanent prostate implants (American Brachytherapy Society, GEC-ESTRO/ACROP).
[[nodiscard]] std::span<const DoseGoal> permanent_prostate_goals();

}  // namespace stylet
