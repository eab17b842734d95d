// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_plan.hpp"

#include <optional>
#include <string>

namespace stylet {

/// A day of the calendar, and the time of the day where it is known.
struct DateTime {
  int year = 0, month = 0, day = 0;
  int seconds = -1;  ///< [s] after midnight; below 0: the time is not known

  [[nodiscard]] std::string dicom_date() const;  ///< "20240102"
  [[nodiscard]] std::string dicom_time() const;  ///< "101500"; empty where the time is not known
  [[nodiscard]] std::string text() const;        ///< "2024-01-02" or "2024-01-02 10:15"
};

/// Reads "20240102", "2024-01-02" or "2024.01.02", followed by a time "101500", "10:15" or "10:15:30" where there is
/// one, after a blank or a T. Empty: the text is no such date, or no day of the calendar.
std::optional<DateTime> parse_date_time(const std::string& text);

/// The days from one moment to another [d]. A time that one of them does not know is not counted.
double days_between(const DateTime& from, const DateTime& to);

/// The date of the strengths of a plan beside the date of the plan.
struct StrengthAge {
  std::string strength_date, plan_date;  ///< "2024-01-02 10:15"; empty where the plan does not say it
  std::optional<double> days;            ///< [d] from the strengths to the plan; empty where a date is not known
  /// Strength at the date of the plan / strength that the plan gives. Empty where a date is not known, or where the
  /// dates are further apart than kMostHalfLives: such dates are made up, as those of anonymised plans.
  std::optional<double> factor_between;
  double factor_used = 1.0;  ///< strength at the implantation that the dose was computed with / strength of the plan

  static constexpr double kMostHalfLives = 10.0;
};

/// @param half_life_days [d] of the sources
/// @param decay_days [d] from the date of the strengths to the implantation, as the dose was computed with
StrengthAge strength_age(const DosePlan& plan, double half_life_days, double decay_days);

/// The age as a sentence for the user; empty where the plan has no date of the strengths.
std::string strength_sentence(const StrengthAge& age);

/// Whether the decay between the dates, which the dose leaves out or takes otherwise, changes it by more than 1 %.
bool strength_is_in_doubt(const StrengthAge& age);

}  // namespace stylet
