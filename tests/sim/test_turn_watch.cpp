// SPDX-License-Identifier: GPL-3.0-or-later
// Tests when a base that moves back and forth counts as turned.
#include "stylet/sim/turn_watch.hpp"

#include <gtest/gtest.h>

using namespace stylet;

namespace {

/// Moves a base from depth to depth [mm], one second each, with a force of minus the depth.
struct Base {
  TurnWatch watch;
  double depth = 0.0;
  double time = 0.0;

  std::optional<TurnWatch::Moment> to(double there) {
    const double advance = there - depth;
    depth = there;
    time += 1.0;
    return watch.follow(advance, {time, depth, -depth, true});
  }
};

}  // namespace

TEST(TurnWatch, tells_of_a_turn_where_it_was) {
  Base base;
  EXPECT_FALSE(base.to(10.0));
  EXPECT_FALSE(base.to(20.0));
  const auto turned = base.to(19.0);
  ASSERT_TRUE(turned);
  EXPECT_EQ(turned->depth_mm, 20.0);
  EXPECT_EQ(turned->time_s, 2.0);
  EXPECT_EQ(turned->force_N, -20.0);
  EXPECT_TRUE(base.watch.retracting());
  const auto in_again = base.to(21.0);
  ASSERT_TRUE(in_again);
  EXPECT_EQ(in_again->depth_mm, 19.0);
  EXPECT_FALSE(base.watch.retracting());
}

TEST(TurnWatch, takes_a_tremor_for_none) {
  Base base;
  base.to(20.0);
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(base.to(k % 2 == 0 ? 19.96 : 20.0)) << k;
  EXPECT_FALSE(base.watch.retracting());
}

TEST(TurnWatch, adds_up_small_steps_back) {
  Base base;
  base.to(20.0);
  int turns = 0;
  for (int k = 1; k <= 10; ++k) turns += base.to(20.0 - 0.02 * k) ? 1 : 0;
  EXPECT_EQ(turns, 1);
}

TEST(TurnWatch, a_base_that_stands_still_has_not_turned) {
  Base base;
  base.to(20.0);
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(base.to(20.0));
}
