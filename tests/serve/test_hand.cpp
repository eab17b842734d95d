// SPDX-License-Identifier: GPL-3.0-or-later
#include "hand.hpp"

#include "sim/box_patient.hpp"

#include <numbers>

using namespace stylet;
using namespace stylet::serve;

namespace {

constexpr double kLength_mm = 200.0;

PlannedInsertion plan_along(const Vec3& direction) {
  PlannedInsertion plan;
  plan.entry = {3, -4, -50};
  plan.direction = direction.normalized();
  plan.depth_mm = 60.0;
  plan.motion = BaseMotion::straight(plan.entry, plan.direction, kLength_mm, 3.0, 60.0, 20.0, 0.0, false, 20.0);
  return plan;
}

Vec3 tip(const Pose& base) { return base.origin + kLength_mm * (base.rotation * Vec3::UnitZ()); }

/// Reads the device a thousand times per second for `seconds`. @return the last sample
Pose after(PageDevice& device, double& now_s, double seconds) {
  DeviceInput input;
  const int turns = static_cast<int>(std::lround(1000.0 * seconds));
  for (int k = 0; k < turns; ++k) {
    now_s += 1e-3;
    input = device.read({.now_s = now_s, .simulated_s = now_s});
  }
  EXPECT_TRUE(input.valid);
  return pose(input.pose);
}

}  // namespace

TEST(Hand, without_tilt_is_on_the_planned_way) {
  for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(0.2, -0.3, 1), Vec3(1, 0, 0.1), Vec3(0, -1, 0)}) {
    const PlannedInsertion plan = plan_along(direction);
    for (const double depth : {-3.0, 0.0, 25.0}) {
      const Pose base = hand_pose({.depth_mm = depth}, plan, kLength_mm);
      EXPECT_LT((tip(base) - (plan.entry + depth * plan.direction)).norm(), 1e-9);
      const Pose start = plan.motion.at(0.0);
      EXPECT_LT(base.rotation.angularDistance(start.rotation), 1e-9) << "the plan's roll";
    }
  }
}

TEST(Hand, tilts_the_hub_to_the_side_it_says_about_the_skin_point) {
  const PlannedInsertion plan = plan_along({0, 0, 1});
  const Pose left = hand_pose({.depth_mm = 30.0, .tilt_left_deg = 5.0}, plan, kLength_mm);
  EXPECT_GT(left.origin.x(), plan.entry.x() + 10.0);  // LPS: x to the left
  EXPECT_LT(tip(left).x(), plan.entry.x() - 2.0);
  const Pose anterior = hand_pose({.depth_mm = 30.0, .tilt_anterior_deg = 5.0}, plan, kLength_mm);
  EXPECT_LT(anterior.origin.y(), plan.entry.y() - 10.0);  // y to posterior
  for (const Pose& base : {left, anterior}) {
    const Vec3 axis = base.rotation * Vec3::UnitZ();
    const Vec3 to_entry = plan.entry - base.origin;
    EXPECT_LT((to_entry - to_entry.dot(axis) * axis).norm(), 1e-9) << "the needle goes through the skin point";
    EXPECT_NEAR(std::acos(axis.dot(plan.direction)) * 180.0 / std::numbers::pi, 5.0, 1e-9);
  }
}

TEST(Hand, rolls_about_the_axis_alone) {
  const PlannedInsertion plan = plan_along({0.1, 0, 1});
  const Pose base = hand_pose({.depth_mm = 10.0, .roll_deg = 90.0}, plan, kLength_mm);
  const Pose zero = hand_pose({.depth_mm = 10.0}, plan, kLength_mm);
  EXPECT_LT((base.origin - zero.origin).norm(), 1e-12);
  EXPECT_LT((base.rotation * Vec3::UnitX() - zero.rotation * Vec3::UnitY()).norm(), 1e-9);
}

TEST(Hand, angles_of_a_base_are_those_it_was_placed_with) {
  for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(0.2, -0.3, 1), Vec3(1, 0.2, 0.1), Vec3(0.1, -1, 0)}) {
    const PlannedInsertion plan = plan_along(direction);
    const HandTarget placed{.depth_mm = 30.0, .roll_deg = -130.0, .tilt_left_deg = 7.0, .tilt_anterior_deg = -4.0};
    Pose base = hand_pose(placed, plan, kLength_mm);
    base.origin += Vec3(50, -20, 10);  // the position must not matter
    const HandTarget found = hand_angles(base, plan);
    EXPECT_NEAR(found.roll_deg, placed.roll_deg, 1e-9);
    EXPECT_NEAR(found.tilt_left_deg, placed.tilt_left_deg, 1e-9);
    EXPECT_NEAR(found.tilt_anterior_deg, placed.tilt_anterior_deg, 1e-9);
  }
}

TEST(Hand, a_needle_between_left_and_anterior_has_one_way_to_tilt) {
  const PlannedInsertion plan = plan_along({1, -1, 0});
  const auto tangent = [](double degrees) { return std::tan(degrees * std::numbers::pi / 180.0); };
  const HandTarget placed{.depth_mm = 30.0, .roll_deg = 20.0, .tilt_left_deg = 7.0};
  const HandTarget found = hand_angles(hand_pose(placed, plan, kLength_mm), plan);
  EXPECT_NEAR(found.roll_deg, 20.0, 1e-6);
  EXPECT_NEAR(tangent(found.tilt_left_deg), tangent(7.0), 1e-6);
  EXPECT_EQ(found.tilt_anterior_deg, 0.0);
}

TEST(PageDevice, starts_where_the_plan_does_and_waits_for_a_target) {
  const Scenario scenario = test::box_scenario();
  PlannedInsertion plan = plan_along({0, 0, 1});
  plan.motion = BaseMotion::straight(plan.entry, plan.direction, scenario.needle.length_mm, 3.0, 60.0, 20.0, 0.0, false,
                                     20.0, 0.7);
  PageDevice device(plan, scenario);
  double now = 0.0;
  const Pose base = after(device, now, 0.5);
  const Pose start = plan.motion.at(0.0);
  EXPECT_LT((base.origin - start.origin).norm(), 1e-9);
  EXPECT_LT(base.rotation.angularDistance(start.rotation), 1e-7);
  EXPECT_NEAR(device.place().depth_mm, -3.0, 1e-9);
}

TEST(PageDevice, goes_to_its_target_as_fast_as_asked_and_no_further) {
  const Scenario scenario = test::box_scenario();
  PageDevice device(plan_along({0, 0, 1}), scenario);
  double now = 0.0;
  const double from = device.place().depth_mm;
  device.aim({.depth_mm = 20.0, .speed_mm_per_s = 10.0});
  after(device, now, 1.0);
  EXPECT_NEAR(device.place().depth_mm, from + 10.0, 0.02);
  after(device, now, 10.0);
  EXPECT_NEAR(device.place().depth_mm, 20.0, 1e-12);
  // A target beyond the limits of depth and speed.
  device.aim({.depth_mm = 1e6, .speed_mm_per_s = 1e6});
  after(device, now, 0.1);
  const HandLimits limits = hand_limits(scenario);
  EXPECT_NEAR(device.place().depth_mm, 20.0 + 0.1 * limits.speed_mm_per_s, 0.3);
  after(device, now, 10.0);
  EXPECT_EQ(device.place().depth_mm, limits.depth_mm);
  EXPECT_LT(limits.depth_mm, scenario.needle.length_mm);
}

TEST(PageDevice, rests_where_it_is_when_it_is_let_go) {
  const Scenario scenario = test::box_scenario();
  PageDevice device(plan_along({0, 0, 1}), scenario);
  double now = 0.0;
  device.aim({.depth_mm = 20.0, .speed_mm_per_s = 10.0});
  after(device, now, 0.5);
  const double there = device.place().depth_mm;
  device.aim({.rest = true});
  after(device, now, 1.0);
  EXPECT_EQ(device.place().depth_mm, there);
}

TEST(PageDevice, at_no_speed_stays_as_deep_as_it_is_wherever_it_was_sent_and_still_turns) {
  const Scenario scenario = test::box_scenario();
  PageDevice device(plan_along({0, 0, 1}), scenario);
  double now = 0.0;
  device.aim({.depth_mm = 20.0, .speed_mm_per_s = 10.0});
  after(device, now, 0.5);
  const double there = device.place().depth_mm;
  for (const double seen_before : {there - 2.0, there, there + 5.0}) {
    device.aim({.depth_mm = seen_before, .speed_mm_per_s = 0.0, .roll_deg = 30.0});
    after(device, now, 0.5);
    EXPECT_EQ(device.place().depth_mm, there);
  }
  EXPECT_EQ(device.place().roll_deg, 30.0);
}

TEST(PageDevice, stands_while_simulated_time_stands) {
  const Scenario scenario = test::box_scenario();
  PageDevice device(plan_along({0, 0, 1}), scenario);
  device.aim({.depth_mm = 20.0, .speed_mm_per_s = 10.0});
  (void)device.read({.now_s = 0.0, .simulated_s = 0.0});
  const double there = device.place().depth_mm;
  for (int k = 1; k < 1000; ++k) (void)device.read({.now_s = 1e-3 * k, .simulated_s = 0.0});
  EXPECT_EQ(device.place().depth_mm, there);
}
