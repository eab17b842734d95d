// SPDX-License-Identifier: GPL-3.0-or-later
#include "rests.hpp"

#include "stylet/coupling/insertion.hpp"

#include <gtest/gtest.h>

#include <vector>

using namespace stylet;
using namespace stylet::serve;

namespace {

/// Adds steps of 1 ms with these forces. @return the recorded steps
std::vector<Step> recorded(const std::vector<double>& forces_N) {
  Rests rests;
  std::vector<Step> records;
  Step step;
  step.dt_s = 1e-3;
  for (std::size_t k = 0; k < forces_N.size(); ++k) {
    step.time_s = 1e-3 * static_cast<double>(k + 1);
    step.force_axial_N = forces_N[k];
    step.step_us = static_cast<double>(k);
    if (const auto record = rests.add(step)) records.push_back(*record);
  }
  if (const auto record = rests.end()) records.push_back(*record);
  return records;
}

}  // namespace

TEST(Rests, steps_that_are_the_same_but_for_their_time_are_counted) {
  const auto records = recorded({1, 2, 2, 2, 2, 3});
  ASSERT_EQ(records.size(), 3u);
  EXPECT_EQ(records[1].force_axial_N, 2.0);
  EXPECT_EQ(records[1].rest_steps, 0);
  EXPECT_EQ(records[2].force_axial_N, 3.0);
  EXPECT_EQ(records[2].rest_steps, 3);
}

TEST(Rests, a_rest_at_the_end_ends_with_its_last_step) {
  const auto records = recorded({1, 1, 1, 1});
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[1].time_s, 4e-3);
  EXPECT_EQ(records[1].rest_steps, 2);
  EXPECT_EQ(recorded({1, 2}).size(), 2u);
  EXPECT_EQ(recorded({1, 1}).back().rest_steps, 0);
}

TEST(Rests, rounding_is_no_motion_and_a_drift_is_one) {
  EXPECT_EQ(recorded({1.0, 1.0 + 1e-15, 1.0, 1.0 - 1e-15, 2.0}).size(), 2u);
  EXPECT_EQ(recorded({1.0, 1.0 + 2e-7}).size(), 2u);
  std::vector<double> drift_N;
  for (int k = 0; k < 1000; ++k) drift_N.push_back(1.0 + 1e-9 * k);
  const auto records = recorded(drift_N);
  EXPECT_GE(records.size(), 10u);
  EXPECT_LE(records.size(), 12u);
}

TEST(Rests, what_a_step_was_given_is_compared_to_the_last_bit) {
  Rests rests;
  Step step;
  step.dt_s = 1e-3;
  EXPECT_TRUE(rests.add(step));
  EXPECT_FALSE(rests.add(step));
  step.dt_s = 2e-3;  // a step of another duration may have another result
  EXPECT_TRUE(rests.add(step));
  step.base.origin.z() = 1e-300;
  EXPECT_TRUE(rests.add(step));
  step.base.origin.z() = -0.0;
  EXPECT_TRUE(rests.add(step));
  step.tip_mm.x() = 2e-7;
  EXPECT_TRUE(rests.add(step));
  step.torque_Nmm.x() = 2e-5;
  EXPECT_TRUE(rests.add(step));
  step.sticking = 1;
  EXPECT_TRUE(rests.add(step));
  step.flags = Step::no_contact_inside;  // the start and the end of a warning must be recorded
  EXPECT_TRUE(rests.add(step));
  EXPECT_FALSE(rests.add(step));
  step.flags = 0;
  EXPECT_TRUE(rests.add(step));
}

TEST(Rests, a_step_that_is_missing_ends_a_rest) {
  Rests rests;
  Step step;
  step.dt_s = 1e-3;
  const auto at = [&](double time_s) {
    step.time_s = time_s;
    return step;
  };
  EXPECT_TRUE(rests.follows(at(0.5)));  // there is no step before it
  EXPECT_TRUE(rests.add(at(0.001)));
  EXPECT_TRUE(rests.follows(at(0.002)));
  EXPECT_FALSE(rests.add(at(0.002)));
  EXPECT_TRUE(rests.follows(at(0.003)));
  EXPECT_FALSE(rests.follows(at(0.004)));
}
