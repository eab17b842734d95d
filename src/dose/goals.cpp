// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/goals.hpp"

#include <charconv>
#include <cmath>
#include <string_view>

namespace stylet {

namespace {

Error no_metric(const std::string& text, const std::string& where) {
  return input_error(where, "'" + text + "' is not a figure of a dose–volume histogram",
                     "Write for example D90_percent, D90_Gy, D2cc_Gy, D0.1cc_percent, V100_percent or V150_cc");
}

/// The amount at the start of a text, which is removed from it. Empty: there is no number above 0.
double take_amount(std::string_view& text) {
  double amount = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), amount);
  if (error != std::errc() || !(amount > 0.0)) return 0.0;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return amount;
}

}  // namespace

Result<DoseMetric> parse_metric(const std::string& text, const std::string& where) {
  std::string_view rest = text;
  if (rest.size() < 4 || (rest.front() != 'D' && rest.front() != 'V')) return no_metric(text, where);
  const bool is_dose = rest.front() == 'D';
  rest.remove_prefix(1);
  DoseMetric metric;
  metric.amount = take_amount(rest);
  if (metric.amount <= 0.0) return no_metric(text, where);
  metric.kind = is_dose ? DoseMetric::Kind::dose_of_percent : DoseMetric::Kind::volume;
  if (is_dose && rest.starts_with("cc")) {
    metric.kind = DoseMetric::Kind::dose_of_cc;
    rest.remove_prefix(2);
  }
  if (metric.kind == DoseMetric::Kind::dose_of_percent && metric.amount > 100.0) return no_metric(text, where);
  if (rest == "_Gy" && is_dose) {
    metric.unit = DoseMetric::Unit::Gy;
  } else if (rest == "_cc" && !is_dose) {
    metric.unit = DoseMetric::Unit::cc;
  } else if (rest == "_percent") {
    metric.unit = DoseMetric::Unit::percent;
  } else {
    return no_metric(text, where);
  }
  return metric;
}

Result<DoseGoal> parse_goal(const GoalText& text, const std::string& where) {
  constexpr const char* bounds = "Write e.g. >=90 or <150";
  if (text.structure.empty())
    return input_error(where, "the goal has no structure", "Write for example prostate, urethra or rectum");
  if (const auto metric = parse_metric(text.metric, where); !metric) return metric.error();
  DoseGoal goal{text.structure, text.metric, true, 0.0, text.citation};
  std::string_view bound = text.bound;
  goal.at_least = bound.starts_with('>');
  if (!bound.starts_with('>') && !bound.starts_with('<'))
    return input_error(where, "the bound '" + text.bound + "' does not begin with > or <", bounds);
  bound.remove_prefix(bound.size() > 1 && bound[1] == '=' ? 2 : 1);
  while (bound.starts_with(' ')) bound.remove_prefix(1);
  while (bound.ends_with(' ')) bound.remove_suffix(1);
  const auto [end, error] = std::from_chars(bound.data(), bound.data() + bound.size(), goal.bound);
  if (bound.empty() || error != std::errc() || end != bound.data() + bound.size())
    return input_error(where, "the bound '" + text.bound + "' has no number", bounds);
  return goal;
}

std::optional<double> figure_of(const DoseMetric& metric, const DoseVolume& dvh, double prescription_Gy) {
  const bool relative = metric.unit == DoseMetric::Unit::percent;
  if (metric.kind == DoseMetric::Kind::volume) {
    if (prescription_Gy <= 0.0) return std::nullopt;
    const double dose = metric.amount / 100.0 * prescription_Gy;
    return relative ? dvh.percent_above(dose) : dvh.volume_above_cc(dose);
  }
  const double dose = metric.kind == DoseMetric::Kind::dose_of_percent ? dvh.dose_of_percent(metric.amount)
                                                                       : dvh.dose_of_volume(metric.amount);
  if (!std::isfinite(dose)) return std::nullopt;
  if (!relative) return dose;
  return prescription_Gy > 0.0 ? std::optional(100.0 * dose / prescription_Gy) : std::nullopt;
}

bool meets(const DoseGoal& goal, double value) { return goal.at_least ? value >= goal.bound : value <= goal.bound; }

std::span<const DoseGoal> permanent_prostate_goals() {
  static const std::vector<DoseGoal> goals = [] {
    const std::string abs = "Davis et al. 2012 (American Brachytherapy Society), Brachytherapy 11:6";
    const std::string estro = "Salembier et al. 2007 (GEC-ESTRO), Radiother Oncol 83:3";
    return std::vector<DoseGoal>{
        {"prostate", "D90_percent", true, 100.0, abs},   {"prostate", "V100_percent", true, 95.0, estro},
        {"prostate", "V150_percent", false, 60.0, abs},  {"prostate", "V200_percent", false, 20.0, abs},
        {"urethra", "D10_percent", false, 150.0, estro}, {"urethra", "D30_percent", false, 130.0, estro},
        {"rectum", "D2cc_percent", false, 100.0, estro}, {"rectum", "D0.1cc_Gy", false, 200.0, estro}};
  }();
  return goals;
}

}  // namespace stylet
