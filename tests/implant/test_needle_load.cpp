// SPDX-License-Identifier: GPL-3.0-or-later
// From a plan of seeds to loaded needles.
#include "stylet/implant/needle_load.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace stylet {
namespace {

PlannedSource seed(const Vec3& at, const std::string& needle = "") {
  return {.at_mm = at, .axis = Vec3::UnitZ(), .has_axis = true, .strength_U = 0.5, .needle = needle};
}

DosePlan plan_of(std::vector<PlannedSource> seeds) {
  DosePlan plan;
  plan.file = "plan.csv";
  plan.sources = std::move(seeds);
  return plan;
}

TEST(LoadNeedles, puts_the_tip_half_a_seed_and_the_plug_beyond_the_first_seed) {
  const DosePlan plan = plan_of({seed(Vec3(5, 2, 0), "D4"), seed(Vec3(5, 2, 20), "D4"), seed(Vec3(5, 2, 10), "D4")});
  const auto needles = load_needles(plan, 4.5, 3.0).value();
  ASSERT_EQ(needles.size(), 1U);
  const NeedleLoad& load = needles.front();
  EXPECT_EQ(load.name, "D4");
  EXPECT_LT((load.tip_mm - Vec3(5, 2, 20 + 2.25 + 3)).norm(), 1e-12);
  EXPECT_LT((load.direction - Vec3::UnitZ()).norm(), 1e-12);
  ASSERT_EQ(load.seeds.size(), 3U);
  const std::array<std::size_t, 3> order{1, 2, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(load.seeds[k].number, order[k]);
    EXPECT_NEAR(load.seeds[k].behind_tip_mm, 5.25 + 10.0 * static_cast<double>(k), 1e-12);
  }
}

TEST(LoadNeedles, finds_the_needles_of_seeds_without_names_in_any_order_and_direction) {
  std::mt19937 random(4);
  for (int round = 0; round < 20; ++round) {
    // Parallel needles, tilted against z, 5 mm apart, whose seeds come in a random order.
    const Vec3 direction = Vec3(0.1 * round / 20.0, -0.2, 1.0).normalized();
    const Vec3 across = direction.cross(Vec3::UnitX()).normalized();
    std::vector<PlannedSource> seeds;
    for (int needle = 0; needle < 6; ++needle) {
      for (int k = 0; k < 4; ++k) {
        seeds.push_back(seed(5.0 * needle * across + 10.0 * k * direction));
        seeds.back().axis = round % 2 == 0 ? direction : Vec3(-direction);
      }
    }
    std::shuffle(seeds.begin(), seeds.end(), random);
    const auto needles = load_needles(plan_of(seeds), 4.5, 0.0).value();
    ASSERT_EQ(needles.size(), 6U);
    for (const NeedleLoad& load : needles) {
      EXPECT_EQ(load.seeds.size(), 4U);
      EXPECT_LT((load.direction - direction).norm(), 1e-9);
      EXPECT_LT(load.beside_line_mm, 1e-9);
      for (const LoadedSeed& s : load.seeds)
        EXPECT_LT((load.tip_mm - s.behind_tip_mm * load.direction - s.planned_mm).norm(), 1e-9);
    }
  }
}

TEST(LoadNeedles, refuses_what_no_straight_needle_can_carry) {
  const auto bent = load_needles(
      plan_of({seed(Vec3(0, 0, 0), "D4"), seed(Vec3(20, 0, 10), "D4"), seed(Vec3(0, 0, 20), "D4")}), 4.5, 0.0);
  ASSERT_FALSE(bent.ok());
  EXPECT_NE(bent.error().message().find("plan.csv, needle D4"), std::string::npos);
  const auto crowded = load_needles(plan_of({seed(Vec3(0, 0, 0), "D4"), seed(Vec3(0, 0, 1), "D4")}), 4.5, 0.0);
  ASSERT_FALSE(crowded.ok());
  EXPECT_NE(crowded.error().message().find("1.00 mm apart"), std::string::npos);
  DosePlan temporary = plan_of({seed(Vec3(0, 0, 0))});
  temporary.implant = Implant::temporary;
  EXPECT_FALSE(load_needles(temporary, 4.5, 0.0).ok());
  EXPECT_FALSE(load_needles(plan_of({}), 4.5, 0.0).ok());
}

TEST(LoadCatheters, takes_the_line_of_the_dwell_positions_and_a_tip_beyond_them_and_keeps_positions_without_time) {
  DosePlan plan = plan_of({seed(Vec3(5, 2, 0), "1"), seed(Vec3(5, 2, 1), "1"), seed(Vec3(-5, 2, 10), "2")});
  plan.implant = Implant::temporary;
  plan.sources[1].dwell_s = 4.0;
  const auto catheters = load_catheters(plan, 7.0).value();
  ASSERT_EQ(catheters.size(), 2U);
  const NeedleLoad& load = catheters.front();
  EXPECT_EQ(load.implant, Implant::temporary);
  EXPECT_LT((load.tip_mm - Vec3(5, 2, 8)).norm(), 1e-12);
  ASSERT_EQ(load.seeds.size(), 2U);
  EXPECT_EQ(load.seeds[0].number, 1U);
  EXPECT_NEAR(load.seeds[1].behind_tip_mm, 8.0, 1e-12);
}

TEST(LoadCatheters, refuses_permanent_plans_plans_without_time_and_bent_channels) {
  DosePlan plan = plan_of({seed(Vec3(0, 0, 0), "1"), seed(Vec3(20, 0, 10), "1"), seed(Vec3(0, 0, 20), "1")});
  EXPECT_NE(load_catheters(plan, 6.0).error().message().find("permanent"), std::string::npos);
  plan.implant = Implant::temporary;
  EXPECT_NE(load_catheters(plan, 6.0).error().message().find("above 0 s"), std::string::npos);
  plan.sources[0].dwell_s = 1.0;
  const std::string bent = load_catheters(plan, 6.0).error().message();
  EXPECT_NE(bent.find("plan.csv, catheter 1"), std::string::npos) << bent;
  EXPECT_NE(bent.find("dwell positions lie up to"), std::string::npos) << bent;
}

TEST(OrderNeedles, is_by_height_or_as_planned) {
  std::vector<NeedleLoad> needles(3);
  for (std::size_t k = 0; k < 3; ++k) {
    needles[k].name = std::string(1, "abc"[k]);
    needles[k].tip_mm = Vec3(0, std::array{5.0, -5.0, 10.0}[k], 0);
  }
  const auto names = [&](NeedleOrder order) {
    std::vector<NeedleLoad> sorted = needles;
    order_needles(sorted, order);
    std::string all;
    for (const NeedleLoad& load : sorted) all += load.name;
    return all;
  };
  EXPECT_EQ(names(NeedleOrder::plan), "abc");
  EXPECT_EQ(names(NeedleOrder::anterior_first), "bac");
  EXPECT_EQ(names(NeedleOrder::posterior_first), "cab");
}

}  // namespace
}  // namespace stylet
