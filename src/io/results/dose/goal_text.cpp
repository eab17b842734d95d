// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/goal_text.hpp"

#include "fixed_number.hpp"

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

std::string with_figure_unit(const std::string& value, const DoseGoal& goal) {
  const std::string unit = figure_unit(goal);
  return unit.empty() ? value : value + " " + unit;
}

std::string reached_text(const JudgedGoal& judged) {
  if (!judged.value) return "–";
  return with_figure_unit(fixed(*judged.value, judged.goal.metric.ends_with("_cc") ? 2 : 1), judged.goal);
}

std::string verdict_badge(const JudgedGoal& judged) {
  const auto make = [](const char* style, const char* sign, const char* word) {
    return fmt::format("<span class=\"verdict {}\"><i>{}</i>{}</span>", style, sign, word);
  };
  if (!judged.value) return make("skipped", "–", "not judged");
  return judged.met ? make("pass", "✓", "met") : make("missed", "✗", "missed");
}

}  // namespace stylet::results
