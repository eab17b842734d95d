// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/goals.hpp"

#include <string>

namespace stylet::results {

/// The bound of a goal: ">= 90", "<= 50".
std::string bound_text(const DoseGoal& goal);

/// The figure of a goal without its unit: "D90" for "D90_percent".
std::string figure_name(const DoseGoal& goal);

/// The unit of a goal for display: "%" for "D90_percent", "Gy", "cc".
std::string figure_unit(const DoseGoal& goal);

}  // namespace stylet::results
