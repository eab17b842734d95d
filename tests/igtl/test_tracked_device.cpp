// SPDX-License-Identifier: GPL-3.0-or-later
#include "igtl/tracked_device.hpp"

#include "support/count_allocations.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using namespace stylet::igtl;

namespace {

TrackedPose at(double x) {
  TrackedPose p;
  p.valid = true;
  p.pose.origin[0] = x;
  return p;
}

}  // namespace

TEST(TrackedDevice, a_sample_is_never_taken_for_younger_than_it_is) {
  const auto channel = std::make_shared<PoseChannel>();
  TrackedDevice device("tracker", channel);
  channel->write(at(1));
  DeviceInput in = device.read({.now_s = 10.0});
  EXPECT_FALSE(in.valid) << "it may have been there for an hour";
  EXPECT_FALSE(device.read({.now_s = 10.001}).valid);

  channel->write(at(2));
  in = device.read({.now_s = 10.002});
  EXPECT_TRUE(in.valid);
  EXPECT_EQ(in.time_s, 10.001) << "it came between the two turns";
  EXPECT_EQ(in.pose.origin[0], 2.0);
  in = device.read({.now_s = 10.003});
  EXPECT_TRUE(in.valid);
  EXPECT_EQ(in.time_s, 10.001) << "and grows old";

  channel->write(at(3));
  in = device.read({.now_s = 15.0});
  EXPECT_EQ(in.time_s, 10.003) << "the loop was stopped: it may be as old as the last turn";
}

TEST(TrackedDevice, a_handle_that_is_lost_is_invalid) {
  const auto channel = std::make_shared<PoseChannel>();
  TrackedDevice device("tracker", channel);
  EXPECT_FALSE(device.read({.now_s = 1.0}).valid) << "nobody there yet";
  channel->write(at(1));
  EXPECT_TRUE(device.read({.now_s = 1.001}).valid);
  channel->write({});
  EXPECT_FALSE(device.read({.now_s = 1.002}).valid);
  channel->write(at(1));
  EXPECT_TRUE(device.read({.now_s = 1.003}).valid);
}

TEST(TrackedDevice, feels_nothing) {
  TrackedDevice device("tracker", std::make_shared<PoseChannel>());
  EXPECT_EQ(device.traits().name, "tracker");
  EXPECT_FALSE(device.traits().force);
  EXPECT_FALSE(device.traits().torque);
  EXPECT_EQ(device.traits().damping_N_s_per_mm, 0.0);
}

TEST(TrackedDevice, does_not_allocate) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "not with a sanitizer";
  const auto channel = std::make_shared<PoseChannel>();
  TrackedDevice device("tracker", channel);
  const test::AllocationCount count;
  double sum = 0.0;
  for (int k = 0; k < 100; ++k) {
    channel->write(at(k));
    sum += device.read({.now_s = 0.001 * k}).pose.origin[0];
    device.write({});
  }
  EXPECT_EQ(count.count(), 0);
  EXPECT_EQ(sum, 4950.0);
}
