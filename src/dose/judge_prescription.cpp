// SPDX-License-Identifier: GPL-3.0-or-later
// Rules about what is prescribed and when: prescription, fractions, dates.
#include "dose/rules.hpp"
#include "stylet/dose/strength_age.hpp"

#include <algorithm>
#include <chrono>

namespace stylet::dose {

namespace {

/// A date in days since 1970. Empty: there is none; a day before 1970 stands for none.
std::optional<long> day_of(const std::string& text) {
  const std::optional<DateTime> date = parse_date_time(text);
  if (!date || date->year < 1970) return std::nullopt;
  return std::chrono::sys_days(std::chrono::year_month_day{std::chrono::year(date->year),
                                                           std::chrono::month(static_cast<unsigned>(date->month)),
                                                           std::chrono::day(static_cast<unsigned>(date->day))})
      .time_since_epoch()
      .count();
}

void judge_dates(const Judged& judged, const SourceKind& kind, const SourceModel& model, Findings& found) {
  const std::optional<long> today = day_of(judged.plan.says.today), planned = day_of(judged.plan.plan_date);
  if (planned && today && *planned - *today > 1)
    found.warn(Rule::dates, fmt::format("The date of the plan, {}, lies in the future", judged.plan.plan_date));
  if (kind.strength_date.empty()) return;
  const std::optional<long> strength = day_of(kind.strength_date);
  if (!parse_date_time(kind.strength_date)) {
    found.warn(Rule::dates,
               fmt::format("The date of the strength, '{}', is not a date; it is not used", kind.strength_date));
  }
  if (!strength) return;
  if (today && static_cast<double>(*strength - *today) > kPlanBefore_days)
    found.warn(Rule::dates, fmt::format("The date of the strength, {}, lies in the future", kind.strength_date));
  if (!planned || judged.options.decay_days != 0.0) return;
  const auto days = static_cast<double>(*planned - *strength);
  const double left = std::exp2(-days / model.half_life_days);
  if (days < -kPlanBefore_days) {
    found.warn(Rule::dates, fmt::format("The strengths are those of {}, and the plan is dated {}, {:g} days before",
                                        kind.strength_date, judged.plan.plan_date, -days));
  } else if (days > StrengthAge::kMostHalfLives * model.half_life_days) {
    found.warn(Rule::dates,
               fmt::format("The strengths are those of {}, and the plan is dated {}: they decay to {:.1f} % by then, "
                           "which is not in the dose; --decay-days {:g} counts it",
                           kind.strength_date, judged.plan.plan_date, 100.0 * left, days));
  }
}

void judge_fractions(const Judged& judged, Findings& found) {
  const PlanSays& says = judged.plan.says;
  if (!judged.temporary() && says.fractions > 1) {
    found.warn(Rule::fractions, fmt::format("The implant is permanent, and the plan has {} fractions; the dose is that "
                                            "of one implant",
                                            says.fractions));
  } else if (says.fractions > 40 || says.fractions < 0) {
    found.warn(Rule::fractions, fmt::format("The plan has {} fractions", says.fractions));
  }
  const auto same = [](double a, double b) { return std::abs(a - b) < 0.01 * std::max(a, b); };
  for (const double dose : says.prescriptions) {
    if (same(dose, says.prescriptions.front())) continue;
    found.warn(Rule::prescriptions_differ, fmt::format("The plan prescribes {:g} Gy and {:g} Gy to targets; {:g} Gy is "
                                                       "used",
                                                       says.prescriptions.front(), dose, judged.plan.prescription_Gy));
    break;
  }
  if (says.prescriptions.empty() || says.setup_doses.empty()) return;
  const double target = says.prescriptions.front();
  double sum = 0.0;
  for (const double dose : says.setup_doses) sum += dose;
  const double fractions = std::max(1, says.fractions);
  const bool fits = same(sum, target) || same(fractions * sum, target) || same(says.setup_doses.front(), target) ||
                    same(fractions * says.setup_doses.front(), target);
  if (fits) return;
  found.warn(
      Rule::prescriptions_differ,
      fmt::format("The target's prescription is {:g} Gy (300A,0026), and the setups' dose is {:g} Gy (300A,00A4) "
                  "in {:g} fraction{}; {:g} Gy is used",
                  target, sum, fractions, fractions > 1 ? "s" : "", judged.plan.prescription_Gy));
}

}  // namespace

void judge_prescription(const Judged& judged, Findings& found) {
  const DosePlan& plan = judged.plan;
  const double own = judged.options.prescription_Gy;
  const double prescribed = own > 0.0 ? own : plan.prescription_Gy;
  const bool long_lying = judged.temporary() && !judged.is_high_rate();
  const Range range = judged.temporary() && !long_lying ? kFraction_Gy : kPermanent_Gy;
  const bool has_target = std::any_of(judged.structures.begin(), judged.structures.end(),
                                      [](const DoseStructure& s) { return s.region == "prostate"; });
  if (prescribed == 0.0) {
    if (has_target)
      found.warn(Rule::prescription_missing,
                 "The plan has no prescribed dose, so no figure is given in per cent of it "
                 "and no goal in per cent is judged; --prescription gives it");
  } else if (!range.possible(prescribed)) {
    found.refuse(
        Rule::prescription, own > 0.0 ? "--prescription" : plan.file,
        fmt::format("the prescribed dose is {:g} Gy, {:g} … {:g} Gy is expected", prescribed, range.low, range.high),
        "Give the prescribed dose in Gy; --prescription takes the place of the plan's");
  } else if (!range.plausible(prescribed)) {
    found.warn(Rule::prescription,
               fmt::format("The prescribed dose is {:g} Gy, {:g} … {:g} Gy is expected; check its unit", prescribed,
                           range.low, range.high));
  }
  if (own > 0.0 && plan.prescription_Gy > 0.0 &&
      std::max(own, plan.prescription_Gy) > 1.5 * std::min(own, plan.prescription_Gy)) {
    found.warn(
        Rule::prescriptions_differ,
        fmt::format("The plan prescribes {:g} Gy, and --prescription {:g} Gy is used", plan.prescription_Gy, own));
  }
  judge_fractions(judged, found);
  for (std::size_t kind = 0; kind < judged.models.size() && kind < kind_count(plan); ++kind)
    judge_dates(judged, source_kind(plan, kind), judged.models[kind], found);
}

}  // namespace stylet::dose
