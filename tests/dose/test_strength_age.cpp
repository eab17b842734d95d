// SPDX-License-Identifier: GPL-3.0-or-later
// The date of the strengths beside the date of the plan.
#include "stylet/dose/evaluate.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/strength_age.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stylet {
namespace {

DosePlan plan_of(const std::string& strengths, const std::string& planned) {
  DosePlan plan;
  plan.strength_date = strengths;
  plan.plan_date = planned;
  plan.sources.push_back({.strength_U = 0.5});
  return plan;
}

TEST(StrengthAge, reads_dates_as_dicom_and_people_write_them) {
  for (const char* text : {"20240229", "2024-02-29", "2024.02.29"}) {
    const auto date = parse_date_time(text);
    ASSERT_TRUE(date) << text;
    EXPECT_EQ(date->dicom_date(), "20240229");
    EXPECT_EQ(date->dicom_time(), "");
  }
  for (const char* text :
       {"20240229 101500", "2024-02-29T10:15", "2024-02-29 10:15:00", "20240229 101500.25", "20240229 1015"})
    EXPECT_EQ(parse_date_time(text).value().dicom_time(), "101500") << text;
  for (const char* text : {"", "2024", "20230229", "2024-13-01", "2024-1-31", "31.01.2024", "20240229 25",
                           "20240229 106000", "20240229 10:15h", "yesterday", "2024-02.29", "20240229x"})
    EXPECT_FALSE(parse_date_time(text)) << text;
}

TEST(StrengthAge, has_the_decay_between_the_dates) {
  const StrengthAge week = strength_age(plan_of("20240102", "20240109"), 59.4, 0.0);
  EXPECT_DOUBLE_EQ(week.days.value(), 7.0);
  EXPECT_DOUBLE_EQ(week.factor_between.value(), std::exp2(-7.0 / 59.4));
  EXPECT_TRUE(strength_is_in_doubt(week));
  EXPECT_NE(strength_sentence(week).find("0.9216"), std::string::npos) << strength_sentence(week);
  EXPECT_NE(strength_sentence(week).find("without decay"), std::string::npos);
  // Times count where both are known; seeds may be ordered for a day after the plan.
  EXPECT_DOUBLE_EQ(strength_age(plan_of("20240102 180000", "20240103 060000"), 59.4, 0.0).days.value(), 0.5);
  EXPECT_DOUBLE_EQ(strength_age(plan_of("20240102 180000", "20240103"), 59.4, 0.0).days.value(), 1.0);
  EXPECT_GT(strength_age(plan_of("20240109", "20240102"), 59.4, 0.0).factor_between.value(), 1.0);
  // The user has taken the decay into account.
  EXPECT_FALSE(strength_is_in_doubt(strength_age(plan_of("20240102", "20240109"), 59.4, 7.0)));
  EXPECT_FALSE(strength_is_in_doubt(strength_age(plan_of("20240102", "20240102"), 59.4, 0.0)));
}

TEST(StrengthAge, gives_no_factor_for_dates_that_are_missing_or_made_up) {
  EXPECT_EQ(strength_sentence(strength_age(plan_of("", "20240109"), 59.4, 0.0)), "");
  const StrengthAge no_plan = strength_age(plan_of("20240102", ""), 59.4, 0.0);
  EXPECT_FALSE(no_plan.factor_between);
  EXPECT_FALSE(strength_is_in_doubt(no_plan));
  const StrengthAge anonymised = strength_age(plan_of("20160630 000000", "19010101 000000"), 73.83, 0.0);
  EXPECT_FALSE(anonymised.factor_between);
  EXPECT_TRUE(strength_is_in_doubt(anonymised));
  EXPECT_NE(strength_sentence(anonymised).find("cannot both be right"), std::string::npos);
}

TEST(StrengthAge, is_said_by_the_evaluation_of_a_plan) {
  const SourceModel source = find_source("i125_6711").value();
  const DoseEvaluation old = evaluate_dose(plan_of("20240102", "20240302"), source, {}, {.grid_step_mm = 5.0}).value();
  ASSERT_EQ(old.warnings.size(), 1U);
  EXPECT_NE(old.warnings.front().find("60 days later"), std::string::npos) << old.warnings.front();
  const DoseEvaluation fresh =
      evaluate_dose(plan_of("20240102", "20240102"), source, {}, {.grid_step_mm = 5.0}).value();
  EXPECT_TRUE(fresh.warnings.empty());
}

}  // namespace
}  // namespace stylet
