// SPDX-License-Identifier: GPL-3.0-or-later
// Needles that are aimed beside their plan.
#include "stylet/implant/compensation.hpp"
#include "stylet/implant/seed_errors.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

std::vector<NeedleLoad> loaded_needles() {
  std::vector<NeedleLoad> needles(2);
  for (std::size_t k = 0; k < 2; ++k) {
    needles[k].tip_mm = Vec3(10.0 * static_cast<double>(k), 0, 40);
    for (std::size_t s = 0; s < 3; ++s)
      needles[k].seeds.push_back(
          {.number = 3 * k + s, .planned_mm = needles[k].tip_mm - Vec3(0, 0, 10.0 * static_cast<double>(s))});
  }
  return needles;
}

/// Tissue that moves every seed by a smooth function of the place where it is dropped.
Result<ImplantHistory> invented(const std::vector<NeedleLoad>& needles) {
  ImplantHistory history;
  for (std::size_t k = 0; k < needles.size(); ++k) {
    history.needles.emplace_back();
    for (const LoadedSeed& loaded : needles[k].seeds) {
      SeedHistory seed;
      seed.number = loaded.number;
      seed.needle = k;
      seed.planned_mm = loaded.planned_mm;
      seed.dropped_mm = loaded.planned_mm + needles[k].aim_mm;
      seed.by(SeedCause::aim) = needles[k].aim_mm;
      seed.by(SeedCause::motion) = Vec3(1.0 + 0.05 * seed.dropped_mm.x(), -0.5, 3.0 + 0.1 * seed.dropped_mm.x());
      seed.rest_mm = seed.dropped_mm + seed.by(SeedCause::motion);
      history.seeds.push_back(seed);
    }
  }
  return history;
}

TEST(Compensate, brings_seeds_to_their_plan_where_all_seeds_of_a_needle_err_alike) {
  const auto done = compensate(loaded_needles(), 8, invented);
  ASSERT_TRUE(done.ok());
  EXPECT_GT(seed_errors(done->before.seeds).mean_mm, 3.0);
  EXPECT_LT(seed_errors(done->after.seeds).mean_mm, 1e-6);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_LT((done->needles[k].tip_mm - loaded_needles()[k].tip_mm - done->needles[k].aim_mm).norm(), 1e-12);
}

TEST(Compensate, keeps_the_plan_where_aiming_makes_it_worse) {
  // A tissue in which the error grows with the aim, faster than the aim makes up for it.
  const auto worse = [](const std::vector<NeedleLoad>& needles) -> Result<ImplantHistory> {
    auto history = invented(needles);
    for (SeedHistory& seed : history->seeds) seed.rest_mm -= 5.0 * needles[seed.needle].aim_mm;
    return history;
  };
  const auto done = compensate(loaded_needles(), 2, worse);
  ASSERT_TRUE(done.ok());
  EXPECT_EQ(seed_errors(done->after.seeds).mean_mm, seed_errors(done->before.seeds).mean_mm);
  EXPECT_TRUE(done->needles[0].aim_mm.isZero(0.0));
}

TEST(Compensate, hands_on_an_error) {
  const auto failing = [](const std::vector<NeedleLoad>&) -> Result<ImplantHistory> {
    return input_error("here", "this fails", "Change it");
  };
  EXPECT_FALSE(compensate(loaded_needles(), 2, failing).ok());
}

}  // namespace
}  // namespace stylet
