// SPDX-License-Identifier: GPL-3.0-or-later
// Strands, jumps and losses.
#include "stylet/implant/seed_fate.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stylet {
namespace {

std::vector<SeedHistory> train(std::mt19937& random, double scatter) {
  std::normal_distribution<double> normal(0.0, scatter);
  std::vector<SeedHistory> seeds(5);
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    seeds[k].number = k;
    seeds[k].planned_mm = Vec3(0, 0, -10.0 * static_cast<double>(k));
    seeds[k].rest_mm = seeds[k].planned_mm + Vec3(0.2 * normal(random), 0.2 * normal(random), normal(random));
    seeds[k].dropped_mm = seeds[k].rest_mm;
    seeds[k].by(SeedCause::bend) = seeds[k].error_mm();
  }
  return seeds;
}

TEST(SettleSeeds, leaves_loose_seeds_where_they_are) {
  std::mt19937 random(1);
  auto seeds = train(random, 2.0);
  const auto before = seeds;
  settle_seeds(seeds, {}, 0);
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    EXPECT_EQ(seeds[k].rest_mm, before[k].rest_mm);
    EXPECT_FALSE(seeds[k].lost);
  }
}

TEST(SettleSeeds, of_a_strand_keeps_the_distances_and_the_causes_add_up) {
  std::mt19937 random(2);
  for (int round = 0; round < 30; ++round) {
    auto seeds = train(random, 1.5);
    settle_seeds(seeds, {.stranded = true, .release_sd_mm = 1.0}, static_cast<std::size_t>(round));
    double along = 0.0;
    for (std::size_t k = 0; k < seeds.size(); ++k) {
      Vec3 sum = Vec3::Zero();
      for (const Vec3& cause : seeds[k].cause_mm) sum += cause;
      EXPECT_LT((sum - seeds[k].error_mm()).norm(), 1e-12);
      along += seeds[k].error_mm().z();
      if (k == 0) continue;
      // Along a bent line neighbours are a little nearer in a straight line.
      const double apart = (seeds[k].rest_mm - seeds[k - 1].rest_mm).norm();
      EXPECT_LT(apart, 10.0 + 1e-9);
      EXPECT_GT(apart, 9.8);
    }
  }
}

TEST(SettleSeeds, can_be_undone_and_done_again_with_the_same_result) {
  std::mt19937 random(4);
  const Scenario::Seed choice{
      .stranded = true, .release_mm = -1.0, .release_sd_mm = 0.5, .loss_percent = 40.0, .random = 7};
  const auto dropped = train(random, 1.5);
  auto settled = dropped;
  settle_seeds(settled, choice, 3);
  auto again = settled;
  for (SeedHistory& seed : again) seed = as_dropped(seed);
  for (std::size_t k = 0; k < dropped.size(); ++k) {
    EXPECT_LT((again[k].rest_mm - dropped[k].rest_mm).norm(), 1e-12);
    EXPECT_LT((again[k].by(SeedCause::bend) - dropped[k].by(SeedCause::bend)).norm(), 1e-12);
    EXPECT_FALSE(again[k].lost);
  }
  settle_seeds(again, choice, 3);
  bool is_any_lost = false;
  for (std::size_t k = 0; k < dropped.size(); ++k) {
    EXPECT_GT((settled[k].rest_mm - dropped[k].rest_mm).norm(), 1e-3);
    EXPECT_LT((again[k].rest_mm - settled[k].rest_mm).norm(), 1e-12);
    for (const SeedCauseWords& words : kSeedCauses)
      EXPECT_LT((again[k].by(words.cause) - settled[k].by(words.cause)).norm(), 1e-12) << words.name;
    EXPECT_EQ(again[k].lost, settled[k].lost);
    is_any_lost = is_any_lost || settled[k].lost;
  }
  EXPECT_TRUE(is_any_lost);
}

TEST(SettleSeeds, jumps_and_loses_as_many_as_asked_and_the_same_ones_again) {
  std::mt19937 random(3);
  double sum = 0.0, squares = 0.0;
  int lost = 0;
  constexpr int rounds = 2000;
  for (std::size_t round = 0; round < rounds; ++round) {
    auto seeds = train(random, 0.0);
    auto again = seeds;
    const Scenario::Seed choice{.release_mm = -1.0, .release_sd_mm = 0.5, .loss_percent = 2.0, .random = 7};
    settle_seeds(seeds, choice, round);
    settle_seeds(again, choice, round);
    for (std::size_t k = 0; k < seeds.size(); ++k) {
      EXPECT_EQ(seeds[k].rest_mm, again[k].rest_mm);
      EXPECT_EQ(seeds[k].lost, again[k].lost);
      const double jump = seeds[k].by(SeedCause::release).z();
      sum += jump;
      squares += jump * jump;
      lost += seeds[k].lost ? 1 : 0;
    }
  }
  const double count = 5.0 * rounds;
  EXPECT_NEAR(sum / count, -1.0, 0.02);
  EXPECT_NEAR(std::sqrt(squares / count - 1.0), 0.5, 0.02);
  EXPECT_NEAR(lost / count, 0.02, 0.005);
}

}  // namespace
}  // namespace stylet
