// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/strength_age.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <vector>

namespace stylet {

namespace {

constexpr double kSeconds_of_day = 86400.0;
constexpr double kDoubt = 0.01;  // difference of strengths that a user should look at

std::chrono::year_month_day calendar_day(const DateTime& t) {
  return {std::chrono::year(t.year), std::chrono::month(static_cast<unsigned>(t.month)),
          std::chrono::day(static_cast<unsigned>(t.day))};
}

bool are_digits(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

/// The numbers of "20240102" or of its parts between one kind of mark; empty if the text is anything else.
std::vector<int> numbers_in(const std::string& text, const char* marks, const std::vector<std::size_t>& widths) {
  std::vector<int> numbers;
  std::size_t at = 0;
  const bool marked =
      widths.front() < text.size() && std::string(marks).find(text[widths.front()]) != std::string::npos;
  const char mark = marked ? text[widths.front()] : '\0';
  for (std::size_t k = 0; k < widths.size() && at < text.size(); ++k) {
    if (k > 0 && marked && text[at++] != mark) return {};
    const std::string part = text.substr(at, widths[k]);
    if (part.size() != widths[k] || !are_digits(part)) return {};
    numbers.push_back(std::stoi(part));
    at += widths[k];
  }
  return at == text.size() ? numbers : std::vector<int>();
}

/// Seconds after midnight of "10", "1015", "101500.25", "10:15" or "10:15:30"; below 0 if the text is no time.
int seconds_of(const std::string& text) {
  const std::size_t point = text.find('.');
  if (point != std::string::npos && !are_digits(text.substr(point + 1))) return -1;
  const std::vector<int> parts = numbers_in(text.substr(0, point), ":", {2, 2, 2});
  if (parts.empty() || parts[0] > 23) return -1;
  int seconds = 3600 * parts[0];
  if (parts.size() > 1) seconds += parts[1] < 60 ? 60 * parts[1] : 86400;
  if (parts.size() > 2) seconds += parts[2] < 60 ? parts[2] : 86400;
  return seconds < 86400 ? seconds : -1;
}

}  // namespace

std::string DateTime::dicom_date() const { return fmt::format("{:04}{:02}{:02}", year, month, day); }

std::string DateTime::dicom_time() const {
  return seconds < 0 ? "" : fmt::format("{:02}{:02}{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

std::string DateTime::text() const {
  const std::string date = fmt::format("{:04}-{:02}-{:02}", year, month, day);
  return seconds < 0 ? date : fmt::format("{} {:02}:{:02}", date, seconds / 3600, seconds / 60 % 60);
}

std::optional<DateTime> parse_date_time(const std::string& text) {
  const std::size_t end = text.find_first_of(" T");
  const std::vector<int> date = numbers_in(text.substr(0, end), "-.", {4, 2, 2});
  if (date.size() != 3) return std::nullopt;
  DateTime t{.year = date[0], .month = date[1], .day = date[2]};
  if (!calendar_day(t).ok()) return std::nullopt;
  if (end == std::string::npos) return t;
  t.seconds = seconds_of(text.substr(end + 1));
  return t.seconds < 0 ? std::nullopt : std::optional(t);
}

double days_between(const DateTime& from, const DateTime& to) {
  const auto days = std::chrono::sys_days(calendar_day(to)) - std::chrono::sys_days(calendar_day(from));
  const bool timed = from.seconds >= 0 && to.seconds >= 0;
  return static_cast<double>(days.count()) + (timed ? (to.seconds - from.seconds) / kSeconds_of_day : 0.0);
}

StrengthAge strength_age(const DosePlan& plan, double half_life_days, double decay_days) {
  StrengthAge age;
  age.factor_used = std::exp2(-decay_days / half_life_days);
  const auto strength = parse_date_time(plan.strength_date);
  const auto planned = parse_date_time(plan.plan_date);
  if (strength) age.strength_date = strength->text();
  if (planned) age.plan_date = planned->text();
  if (!strength || !planned) return age;
  age.days = days_between(*strength, *planned);
  if (std::abs(*age.days) <= StrengthAge::kMostHalfLives * half_life_days)
    age.factor_between = std::exp2(-*age.days / half_life_days);
  return age;
}

std::string strength_sentence(const StrengthAge& age) {
  if (age.strength_date.empty()) return "";
  const std::string used =
      age.factor_used == 1.0
          ? "the dose is computed with the strengths as the plan gives them, without decay"
          : fmt::format("the dose is computed with these strengths times {:.4g} (--decay-days)", age.factor_used);
  if (!age.days) {
    return fmt::format(
        "The strengths are those of {}; the plan has no date of its own, so the decay between is not known; {}.",
        age.strength_date, used);
  }
  const std::string dates =
      fmt::format("The strengths are those of {}, the plan is of {}, {:g} days {}", age.strength_date, age.plan_date,
                  std::abs(*age.days), *age.days < 0.0 ? "earlier" : "later");
  if (!age.factor_between)
    return fmt::format("{}: these dates cannot both be right, so no decay between them is given; {}.", dates, used);
  return fmt::format("{}: the decay factor between them is {:.4f}; {}.", dates, *age.factor_between, used);
}

bool strength_is_in_doubt(const StrengthAge& age) {
  return age.days && (!age.factor_between || std::abs(*age.factor_between / age.factor_used - 1.0) > kDoubt);
}

}  // namespace stylet
