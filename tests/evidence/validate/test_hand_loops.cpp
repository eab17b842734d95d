// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/validate/hand_loops.hpp"

#include "evidence/validate/scene.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using namespace stylet::validate;

TEST(HandLoop, ends_where_it_begins_and_goes_elsewhere_between) {
  Pose start;
  start.origin = {1, 2, 3};
  start.rotation = Eigen::AngleAxisd(0.4, Vec3(1, 2, 2).normalized());
  for (unsigned number = 0; number < 20; ++number) {
    const HandLoop loop(number);
    for (const double share : {0.0, 1.0}) {
      EXPECT_TRUE(loop.at(start, share).origin.isApprox(start.origin, 1e-12)) << number;
      EXPECT_NEAR(loop.at(start, share).rotation.angularDistance(start.rotation), 0.0, 1e-7) << number;
    }
    // The loop closes exactly at its end, and there is no jump before it.
    EXPECT_LT((loop.at(start, 1.0 - 1e-9).origin - start.origin).norm(), 1e-6) << number;
    EXPECT_GT((loop.at(start, 0.37).origin - start.origin).norm(), 1e-4) << number;
    EXPECT_GT(loop.at(start, 0.37).rotation.angularDistance(start.rotation), 1e-5) << number;
  }
}

TEST(HandLoop, each_number_has_its_own) {
  EXPECT_NE(HandLoop(3).depth_mm(), HandLoop(4).depth_mm());
  EXPECT_NE(HandLoop(3).at({}, 0.3).origin, HandLoop(4).at({}, 0.3).origin);
  EXPECT_EQ(HandLoop(3).at({}, 0.3).origin, HandLoop(3).at({}, 0.3).origin);
}

TEST(HandWork, counts_as_given_back_what_neither_the_hand_nor_the_store_paid_for) {
  EXPECT_DOUBLE_EQ((HandWork{.put_in = 10.0, .net = -1.0, .stored = 0.0}.given_back()), 0.1);
  EXPECT_DOUBLE_EQ((HandWork{.put_in = 10.0, .net = -1.0, .stored = -1.0}.given_back()), 0.0);
  EXPECT_DOUBLE_EQ((HandWork{.put_in = 10.0, .net = 3.0, .stored = 1.0}.given_back()), -0.2);
}

TEST(HandWork, of_a_loop_in_tissue_is_not_negative) {
  for (const TissuePreset preset : {TissuePreset::linear, TissuePreset::typical}) {
    Block block;
    block.direction = {0.05, 0.1, 1.0};
    block.scenario.tissue_model.preset = preset;
    const auto model = block.compile();
    ASSERT_TRUE(model.ok()) << model.error().message();
    double smallest_loss = 1.0, largest_loss = 0.0;
    for (unsigned number = 0; number < 4; ++number) {
      const HandWork work = pass_loop(*model, HandLoop(number), 2, 250);
      EXPECT_EQ(work.flags & Step::kDistrusted, 0u) << word(preset) << ' ' << number;
      EXPECT_GT(work.put_in, 0.0) << word(preset) << ' ' << number;
      EXPECT_LT(work.given_back(), 1e-3) << word(preset) << ' ' << number;
      smallest_loss = std::min(smallest_loss, -work.given_back());
      largest_loss = std::max(largest_loss, -work.given_back());
    }
    // There are two kinds: a loop that hardly slides and returns nearly all work except that lost by creep, and a loop
    // that loses much work by friction. Without the work of the torque, the balance would be far off.
    EXPECT_LT(smallest_loss, preset == TissuePreset::linear ? 1e-2 : 5e-2) << word(preset);
    EXPECT_GT(largest_loss, 0.2) << word(preset);
  }
}
