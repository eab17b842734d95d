// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"

#include <string>

namespace stylet::results {

/// The bound of a goal: ">= 90", "<= 50".
std::string bound_text(const DoseGoal& goal);

/// The figure of a goal without its unit: "D90" for "D90_percent".
std::string figure_name(const DoseGoal& goal);

/// The unit of a goal for display: "%" for "D90_percent", "Gy", "cc".
std::string figure_unit(const DoseGoal& goal);

/// A number with the unit of a goal.
std::string with_figure_unit(const std::string& value, const DoseGoal& goal);

/// The value that a plan reaches, with its unit; a dash where there is nothing.
std::string reached_text(const JudgedGoal& judged);

/// The verdict as word, sign and colour, each of which is sufficient by itself, as HTML.
std::string verdict_badge(const JudgedGoal& judged);

}  // namespace stylet::results
