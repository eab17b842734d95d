// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/goal_text.hpp"

#include <fmt/format.h>

namespace stylet::results {

std::string bound_text(const DoseGoal& goal) { return fmt::format("{} {:g}", goal.at_least ? ">=" : "<=", goal.bound); }

std::string figure_name(const DoseGoal& goal) { return goal.metric.substr(0, goal.metric.rfind('_')); }

std::string figure_unit(const DoseGoal& goal) {
  const std::size_t line = goal.metric.rfind('_');
  if (line == std::string::npos) return {};
  const std::string unit = goal.metric.substr(line + 1);
  return unit == "percent" ? "%" : unit;
}

}  // namespace stylet::results
