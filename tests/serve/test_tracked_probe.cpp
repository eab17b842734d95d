// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracked_probe.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <numbers>

using namespace stylet;

namespace {

const ProbeSeat kSeat{{1.0, 40.0, -60.0}, 5.0};

Pose rest() { return pose_of(probe_place({.kind = ProbeKind::biplane}, kSeat)); }

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST(TrackedProbe, follows_a_pose_that_a_stepper_reaches) {
  Scenario tables;
  tables.probe.kind = ProbeKind::biplane;
  tables.probe.balloon_mm = 2.0;
  ProbeSettings wanted = tables.probe;
  wanted.depth_mm = -3.0;
  wanted.lift_mm = 5.0;
  wanted.tilt_deg = 2.0;
  wanted.roll_deg = -30.0;
  EXPECT_EQ(serve::follow(pose_of(probe_place(wanted, kSeat)), kSeat, tables), "");
  EXPECT_NEAR(*tables.probe.depth_mm, -3.0, 1e-9);
  EXPECT_NEAR(tables.probe.lift_mm, 5.0, 1e-9);
  EXPECT_NEAR(tables.probe.tilt_deg, 2.0, 1e-9);
  EXPECT_NEAR(tables.probe.roll_deg, -30.0, 1e-9);
  EXPECT_EQ(tables.probe.balloon_mm, 2.0);
}

TEST(TrackedProbe, says_what_it_leaves_out) {
  Scenario tables;
  const std::string aside = serve::follow({rest().origin - 4.0 * Vec3::UnitX(), rest().rotation}, kSeat, tables);
  EXPECT_TRUE(says(aside, "4 mm to the patient's right")) << aside;
  EXPECT_NEAR(*tables.probe.depth_mm, kSeat.gland_mm, 1e-9) << "the rest is followed";
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(6.0 * std::numbers::pi / 180.0, Vec3::UnitY()));
  const std::string turned = serve::follow({rest().origin, turn * rest().rotation}, kSeat, tables);
  EXPECT_TRUE(says(turned, "turned by 6° to the left")) << turned;
}

TEST(TrackedProbe, does_not_follow_beside_the_rectum_nor_out_of_range) {
  Scenario tables;
  tables.probe.lift_mm = 3.0;
  const Scenario before = tables;
  const std::string beside = serve::follow({rest().origin + 34.0 * Vec3::UnitX(), rest().rotation}, kSeat, tables);
  EXPECT_TRUE(says(beside, "does not follow") && says(beside, "34 mm to the patient's left")) << beside;
  const std::string above = serve::follow({rest().origin - 50.0 * Vec3::UnitY(), rest().rotation}, kSeat, tables);
  EXPECT_TRUE(says(above, "does not follow") && says(above, "probe.lift_mm")) << above;
  const Eigen::Quaterniond backwards(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()));
  EXPECT_TRUE(says(serve::follow({rest().origin, backwards * rest().rotation}, kSeat, tables), "probe.tilt_deg"));
  EXPECT_TRUE(tables.probe == before.probe) << "the probe stays";
}
