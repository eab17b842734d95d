// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of errors, and the plan that was delivered.
#include "stylet/implant/seed_errors.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

SeedHistory seed(std::size_t number, const Vec3& planned, const Vec3& error, std::size_t needle = 0) {
  SeedHistory s;
  s.number = number;
  s.needle = needle;
  s.planned_mm = planned;
  s.rest_mm = planned + error;
  s.by(SeedCause::motion) = error;
  return s;
}

TEST(SeedErrors, are_those_that_one_computes_by_hand) {
  std::vector<SeedHistory> seeds;
  for (const Vec3& error : {Vec3(3, 0, 4), Vec3(-3, 0, 0), Vec3(0, 0, 1)})
    seeds.push_back(seed(seeds.size(), Vec3::Zero(), error));
  const SeedErrors e = seed_errors(seeds);
  EXPECT_EQ(e.seeds, 3U);
  EXPECT_DOUBLE_EQ(e.mean_mm, 3.0);
  EXPECT_DOUBLE_EQ(e.largest_mm, 5.0);
  EXPECT_NEAR(e.p95_mm, 3.0 + 0.9 * 2.0, 1e-12);
  EXPECT_NEAR(e.axes[0].mean_mm, 0.0, 1e-12);
  EXPECT_NEAR(e.axes[0].sd_mm, 3.0, 1e-12);
  EXPECT_NEAR(e.axes[2].mean_mm, 5.0 / 3.0, 1e-12);
  EXPECT_NEAR(e.axes[2].sd_mm, std::sqrt((16.0 + 0.0 + 1.0 - 25.0 / 3.0) / 2.0), 1e-12);
}

TEST(SeedErrors, do_not_count_lost_seeds_and_are_split_by_needle_third_and_cause) {
  ImplantHistory history;
  history.needles.resize(2);
  history.needles[0].name = "C4";
  history.needles[1].name = "E4";
  for (std::size_t k = 0; k < 6; ++k)
    history.seeds.push_back(
        seed(k, Vec3(0, 0, 10.0 * static_cast<double>(k)), Vec3(0, 0, 1.0 + static_cast<double>(k)), k % 2));
  history.seeds[5].lost = true;
  EXPECT_EQ(seed_errors(history.seeds).seeds, 5U);
  EXPECT_DOUBLE_EQ(seed_errors(history.seeds).mean_mm, 3.0);
  const auto needles = errors_by_needle(history);
  ASSERT_EQ(needles.size(), 2U);
  EXPECT_EQ(needles[0].name, "C4");
  EXPECT_DOUBLE_EQ(needles[0].errors.mean_mm, 3.0);
  EXPECT_DOUBLE_EQ(needles[1].errors.mean_mm, 3.0);
  const auto thirds = errors_by_third(history);
  ASSERT_EQ(thirds.size(), 3U);
  EXPECT_EQ(thirds[0].name, "base");
  EXPECT_EQ(thirds[2].name, "apex");
  EXPECT_DOUBLE_EQ(thirds[2].errors.mean_mm, 1.5);
  const auto causes = causes_of_errors(history.seeds);
  EXPECT_DOUBLE_EQ(causes[static_cast<std::size_t>(SeedCause::motion)].mean_mm, 3.0);
  EXPECT_DOUBLE_EQ(causes[static_cast<std::size_t>(SeedCause::bend)].mean_mm, 0.0);
}

TEST(DeliveredPlan, has_the_seeds_where_they_rest_and_none_that_is_lost) {
  DosePlan plan;
  plan.prescription_Gy = 145.0;
  ImplantHistory history;
  history.needles.resize(1);
  history.needles[0].name = "C4";
  for (std::size_t k = 0; k < 4; ++k) {
    plan.sources.push_back(
        {.at_mm = Vec3(0, 0, 10.0 * static_cast<double>(k)), .strength_U = 0.1 * static_cast<double>(k + 1)});
    history.seeds.push_back(seed(k, plan.sources[k].at_mm, Vec3(1, 2, 3)));
    history.seeds[k].axis = Vec3(0.6, 0.0, 0.8);
  }
  history.seeds[2].lost = true;
  const DosePlan delivered = delivered_plan(plan, history);
  ASSERT_EQ(delivered.sources.size(), 3U);
  EXPECT_EQ(delivered.prescription_Gy, 145.0);
  EXPECT_EQ(delivered.sources[2].at_mm, Vec3(1, 2, 33));
  EXPECT_EQ(delivered.sources[2].strength_U, plan.sources[3].strength_U);
  EXPECT_EQ(delivered.sources[2].axis, Vec3(0.6, 0.0, 0.8));
  EXPECT_EQ(delivered.sources[2].needle, "C4");
}

}  // namespace
}  // namespace stylet
