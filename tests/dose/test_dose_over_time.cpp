// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/dose_over_time.hpp"
#include "stylet/dose/known_sources.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stylet {
namespace {

/// 27 seeds on a grid of 10 mm.
DosePlan grid_of_seeds() {
  DosePlan plan;
  plan.file = "plan.csv";
  for (int k = 0; k < 27; ++k) {
    const Vec3 at(10.0 * (k % 3 - 1), 10.0 * (k / 3 % 3 - 1), 10.0 * (k / 9 - 1));
    plan.sources.push_back({.at_mm = at, .axis = Vec3::UnitZ(), .has_axis = true, .strength_U = 0.5});
  }
  return plan;
}

/// Samples of a ball of 18 mm about the seeds.
StructureSamples ball_of_samples(double step_mm) {
  StructureSamples samples;
  for (double x = -18.0; x <= 18.0; x += step_mm) {
    for (double y = -18.0; y <= 18.0; y += step_mm) {
      for (double z = -18.0; z <= 18.0; z += step_mm) {
        if (Vec3(x, y, z).norm() > 18.0) continue;
        samples.points.emplace_back(x, y, z);
        samples.volume_mm3.push_back(step_mm * step_mm * step_mm);
      }
    }
  }
  return samples;
}

SourceModel course_source() { return find_source("i125_6711").value(); }

DoseOptions swelling_by(const Vec3& at_start) {
  DoseOptions options;
  options.swelling = {.centre_mm = Vec3(1, 2, 3), .at_start = at_start, .half_life_days = 9.3};
  options.grid_step_mm = 10.0;
  return options;
}

double d90_of_evaluation(const DoseOptions& options, const StructureSamples& samples) {
  const DoseStructure structure{.name = "ball", .region = "prostate", .type = "", .samples = samples, .contours = {}};
  return evaluate_dose(grid_of_seeds(), course_source(), {&structure, 1}, options)
      .value()
      .structures[0]
      .dvh.dose_of_percent(90.0);
}

TEST(D90OverTime, ends_at_the_dose_of_the_evaluation_with_and_without_swelling) {
  const StructureSamples samples = ball_of_samples(1.5);
  for (const Vec3& at_start : {Vec3(0.14, 0.14, 0.14), Vec3(0.05, 0.1, 0.2)}) {
    const DoseOptions options = swelling_by(at_start);
    const DoseCourse course = d90_over_time(grid_of_seeds(), course_source(), samples, options).value();
    EXPECT_EQ(course.samples, samples.points.size());
    const DoseMoment& last = course.moments.back();
    EXPECT_TRUE(std::isinf(last.days));
    // The table of the dose rate is read at other places where the evaluation sums it over the time before.
    EXPECT_NEAR(last.d90_Gy / d90_of_evaluation(options, samples), 1.0, 5e-4);
    EXPECT_NEAR(last.d90_without_swelling_Gy / d90_of_evaluation(swelling_by(Vec3::Zero()), samples), 1.0, 5e-4);
    EXPECT_GT(last.taken_away_Gy(), 1.0);
  }
}

TEST(D90OverTime, is_that_of_the_evaluation_until_each_day) {
  const StructureSamples samples = ball_of_samples(2.0);
  DoseOptions options = swelling_by(Vec3::Constant(0.14));
  const DoseCourse course = d90_over_time(grid_of_seeds(), course_source(), samples, options).value();
  options.quantity = DoseQuantity::until;
  for (const double days : {5.0, 20.0, 60.0, 200.0}) {
    options.days = days;
    EXPECT_NEAR(course.at(days).d90_Gy / d90_of_evaluation(options, samples), 1.0, 5e-3) << days;
  }
}

TEST(D90OverTime, grows_all_the_time_and_so_does_what_the_swelling_takes_away) {
  const DoseCourse course =
      d90_over_time(grid_of_seeds(), course_source(), ball_of_samples(2.0), swelling_by(Vec3::Constant(0.14))).value();
  ASSERT_EQ(course.moments.size(), 17U);
  EXPECT_EQ(course.moments.front().days, 0.0);
  EXPECT_EQ(course.moments.front().d90_Gy, 0.0);
  for (std::size_t k = 1; k < course.moments.size(); ++k) {
    const DoseMoment &before = course.moments[k - 1], &now = course.moments[k];
    EXPECT_GT(now.days, before.days);
    EXPECT_GT(now.d90_Gy, before.d90_Gy);
    EXPECT_GT(now.taken_away_Gy(), before.taken_away_Gy());
    EXPECT_LT(now.d90_Gy, now.d90_without_swelling_Gy);
  }
  // The swelling halves every 9.3 days, so it takes most at first: less than a third of the sources' dose is given when
  // half of what it takes is taken.
  const DoseMoment half = course.at(course.days_until_half_is_taken());
  EXPECT_NEAR(half.taken_away_Gy() / course.moments.back().taken_away_Gy(), 0.5, 1e-9);
  EXPECT_LT(half.share, 0.33);
}

TEST(D90OverTime, without_swelling_takes_nothing_away) {
  const DoseCourse course =
      d90_over_time(grid_of_seeds(), course_source(), ball_of_samples(2.0), swelling_by(Vec3::Zero())).value();
  for (const DoseMoment& moment : course.moments) EXPECT_NEAR(moment.taken_away_Gy(), 0.0, 1e-9);
  EXPECT_TRUE(std::isnan(course.days_until_half_is_taken()));
  // After one half-life of the sources half of the dose is given.
  EXPECT_NEAR(course.at(59.4).d90_Gy / course.moments.back().d90_Gy, 0.5, 1e-4);
}

TEST(D90OverTime, of_many_samples_is_that_of_a_part_of_them) {
  const StructureSamples samples = ball_of_samples(0.55);
  const DoseOptions options = swelling_by(Vec3::Constant(0.14));
  const DoseCourse course = d90_over_time(grid_of_seeds(), course_source(), samples, options).value();
  EXPECT_LE(course.samples, 100'000U);
  EXPECT_LT(course.samples, samples.points.size());
  EXPECT_NEAR(course.moments.back().d90_Gy / d90_of_evaluation(options, samples), 1.0, 2e-3);
}

TEST(D90OverTime, is_refused_for_a_temporary_implant_and_for_nothing) {
  DosePlan plan = grid_of_seeds();
  EXPECT_NE(d90_over_time(plan, course_source(), {}, {}).error().message().find("no samples"), std::string::npos);
  plan.implant = Implant::temporary;
  EXPECT_NE(d90_over_time(plan, course_source(), ball_of_samples(4.0), {}).error().message().find("temporary"),
            std::string::npos);
  EXPECT_NE(d90_over_time({}, course_source(), ball_of_samples(4.0), {}).error().message().find("no source"),
            std::string::npos);
}

}  // namespace
}  // namespace stylet
