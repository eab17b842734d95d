// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/recorded_steps.hpp"

#include <gtest/gtest.h>

using namespace stylet;

namespace {

Step step_at(double time_s, double force_N, std::int64_t rest_steps = 0) {
  Step step;
  step.time_s = time_s;
  step.dt_s = 1e-3;
  step.force_axial_N = force_N;
  step.rest_steps = rest_steps;
  return step;
}

/// Steps at 1, 2, … 8 ms; the steps at 3, 4, 5 and 6 ms are at rest.
const std::vector<Step> kRecords{step_at(0.001, 1), step_at(0.002, 2), step_at(0.007, 3, 4), step_at(0.008, 4)};

}  // namespace

TEST(RecordedSteps, steps_at_rest_are_those_of_the_record_before_at_their_own_time) {
  const RecordedSteps steps(kRecords);
  ASSERT_EQ(steps.count(), 8);
  const std::vector<double> forces_N{1, 2, 2, 2, 2, 2, 3, 4};
  for (std::int64_t k = 0; k < 8; ++k) {
    EXPECT_EQ(steps.at(k).time_s, static_cast<double>(k + 1) / 1000.0);  // bit for bit as in a simulation
    EXPECT_EQ(steps.at(k).force_axial_N, forces_N[static_cast<std::size_t>(k)]);
    EXPECT_EQ(steps.at(k).rest_steps, 0);
    EXPECT_EQ(steps.is_recorded(k), k < 2 || k > 5);
  }
}

TEST(RecordedSteps, the_step_of_a_moment) {
  const RecordedSteps steps(kRecords);
  EXPECT_EQ(steps.last_at(0.0005), -1);
  EXPECT_EQ(steps.last_at(0.001), 0);
  EXPECT_EQ(steps.last_at(0.0045), 3);
  EXPECT_EQ(steps.last_at(0.00699), 5);
  EXPECT_EQ(steps.last_at(0.007), 6);
  EXPECT_EQ(steps.last_at(1.0), 7);
  EXPECT_EQ(RecordedSteps({}).count(), 0);
  EXPECT_EQ(RecordedSteps({}).last_at(1.0), -1);
}

TEST(RecordedSteps, a_curve_is_level_where_the_needle_rested) {
  const auto steps = with_ends_of_rests(kRecords);
  ASSERT_EQ(steps.size(), 5u);
  EXPECT_EQ(steps[2].time_s, 0.006);
  EXPECT_EQ(steps[2].force_axial_N, 2.0);
  EXPECT_EQ(steps[3].time_s, 0.007);
}
