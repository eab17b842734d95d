// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/period_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace stylet;

namespace {
constexpr std::int64_t kPeriod_ns = 1000;
constexpr std::int64_t kOrigin = 123'456;
}  // namespace

TEST(PeriodGrid, turns_in_time_stand_for_one_period_each) {
  PeriodGrid grid(kOrigin, kPeriod_ns, 4);
  for (int k = 0; k < 100; ++k) {
    ASSERT_EQ(grid.due_ns(), kOrigin + k * kPeriod_ns);
    grid.wake(grid.due_ns() + 50);
    ASSERT_EQ(grid.take(), kPeriod_ns);
    ASSERT_FALSE(grid.finish(grid.due_ns() + 700));
  }
  EXPECT_EQ(grid.skipped(), 0);
  EXPECT_EQ(grid.lost_ns(), 0);
}

TEST(PeriodGrid, a_late_turn_is_a_miss_and_the_next_one_is_due_on_the_original_grid) {
  PeriodGrid grid(kOrigin, kPeriod_ns, 4);
  grid.wake(kOrigin);
  grid.take();
  EXPECT_TRUE(grid.finish(kOrigin + kPeriod_ns + 1));
  EXPECT_EQ(grid.due_ns(), kOrigin + 2 * kPeriod_ns);
  EXPECT_EQ(grid.skipped(), 1);
  grid.wake(grid.due_ns());
  EXPECT_EQ(grid.take(), 2 * kPeriod_ns) << "the time of the point passed over is made up for";
}

TEST(PeriodGrid, a_turn_that_just_makes_it_is_no_miss) {
  PeriodGrid grid(kOrigin, kPeriod_ns, 4);
  grid.wake(kOrigin);
  grid.take();
  EXPECT_FALSE(grid.finish(kOrigin + kPeriod_ns));
  EXPECT_EQ(grid.due_ns(), kOrigin + kPeriod_ns);
  EXPECT_EQ(grid.skipped(), 0);
}

TEST(PeriodGrid, a_late_awakening_skips_what_passed) {
  PeriodGrid grid(kOrigin, kPeriod_ns, 4);
  grid.wake(kOrigin);
  grid.take();
  grid.finish(kOrigin + 10);
  grid.wake(kOrigin + 3 * kPeriod_ns + 200);
  EXPECT_EQ(grid.tick(), 3);
  EXPECT_EQ(grid.take(), 3 * kPeriod_ns);
  EXPECT_EQ(grid.skipped(), 2);
  EXPECT_TRUE(grid.finish(kOrigin + 3 * kPeriod_ns + 900)) << "of the point at 1 T it was to begin at";
}

TEST(PeriodGrid, a_long_stall_costs_simulated_time_instead_of_a_leap) {
  PeriodGrid grid(kOrigin, kPeriod_ns, 4);
  grid.wake(kOrigin);
  grid.take();
  EXPECT_TRUE(grid.finish(kOrigin + 100 * kPeriod_ns + 5));
  grid.wake(grid.due_ns());
  EXPECT_EQ(grid.take(), 4 * kPeriod_ns);
  EXPECT_EQ(grid.lost_ns(), 97 * kPeriod_ns);
}

TEST(PeriodGrid, time_in_pause_does_not_count) {
  PeriodGrid grid(kOrigin, kPeriod_ns, 4);
  for (int k = 0; k < 50; ++k) {
    grid.wake(grid.due_ns());
    grid.pass();
    grid.finish(grid.due_ns() + 1);
  }
  grid.wake(grid.due_ns());
  EXPECT_EQ(grid.take(), kPeriod_ns);
  EXPECT_EQ(grid.lost_ns(), 0);
}

TEST(PeriodGrid, whatever_happens_time_taken_and_lost_is_the_clocks_and_no_turn_comes_early) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    std::exponential_distribution<double> delay(1.0 / (100.0 + 20.0 * seed));
    PeriodGrid grid(kOrigin, kPeriod_ns, 3);
    std::int64_t now = kOrigin - 500;
    std::int64_t taken = 0;
    std::int64_t turns = 0;
    for (int k = 0; k < 1000; ++k) {
      now = std::max(now, grid.due_ns()) + static_cast<std::int64_t>(delay(random));
      const std::int64_t deadline = grid.due_ns() + kPeriod_ns;
      grid.wake(now);
      ASSERT_LE(grid.due_ns(), now);
      ASSERT_GT(grid.due_ns() + kPeriod_ns, now);
      const std::int64_t dt = grid.take();
      ASSERT_GE(dt, kPeriod_ns);
      ASSERT_LE(dt, 3 * kPeriod_ns);
      taken += dt;
      ++turns;
      ASSERT_EQ(taken + grid.lost_ns(), (grid.tick() + 1) * kPeriod_ns);
      ASSERT_EQ(turns + grid.skipped(), grid.tick() + 1);
      now += static_cast<std::int64_t>(delay(random));
      ASSERT_EQ(grid.finish(now), now > deadline);
      ASSERT_GE(grid.due_ns(), now) << "the next turn lies ahead";
    }
  }
}
