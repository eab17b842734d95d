// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/igtl/picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace stylet;
using namespace stylet::igtl;

namespace {

/// A quarter of a circle of radius r that starts at the origin along z and bends towards x.
std::vector<Triple> quarter(double r, int points) {
  std::vector<Triple> line;
  for (int k = 0; k < points; ++k) {
    const double a = 0.5 * std::numbers::pi * k / (points - 1);
    line.push_back({r * (1.0 - std::cos(a)), 0.0, r * std::sin(a)});
  }
  return line;
}

}  // namespace

TEST(TipPose, a_straight_needle_has_the_bases_axes_at_its_tip) {
  const Pose base{{1, 2, 3}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)};  // z to +x
  std::vector<Triple> line;
  for (int k = 0; k < 65; ++k) line.push_back({1.0 + 2.0 * k, 2.0, 3.0});
  const Pose tip = tip_pose(base, line);
  EXPECT_EQ(tip.origin, Vec3(129, 2, 3));
  EXPECT_NEAR(tip.rotation.angularDistance(base.rotation), 0.0, 1e-7);
}

TEST(TipPose, z_is_the_tangent_at_the_tip_and_the_bevel_keeps_its_side) {
  const auto line = quarter(100.0, 65);
  for (const double roll : {0.0, 0.4, -2.0}) {
    const Eigen::Quaterniond rolled(Eigen::AngleAxisd(roll, Vec3::UnitZ()));
    const Pose tip = tip_pose({Vec3::Zero(), rolled}, line);
    EXPECT_NEAR((tip.origin - Vec3(100, 0, 100)).norm(), 0.0, 1e-9);
    // The direction of the last chord would differ by half a spacing, 0.012 rad.
    EXPECT_NEAR((tip.rotation * Vec3::UnitZ() - Vec3::UnitX()).norm(), 0.0, 5e-4);
    // A quarter turn about y takes z to x and x to −z and leaves y. The roll about the needle's axis stays.
    const Vec3 x = std::cos(roll) * -Vec3::UnitZ() + std::sin(roll) * Vec3::UnitY();
    EXPECT_NEAR((tip.rotation * Vec3::UnitX() - x).norm(), 0.0, 5e-4) << "roll " << roll;
  }
}

TEST(TipPose, a_needle_without_length_is_where_its_base_is) {
  const Pose base{{1, 2, 3}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)};
  const std::vector<Triple> line(65, Triple{1, 2, 3});
  for (const auto& some : {line, std::vector<Triple>{}, std::vector<Triple>(1, Triple{1, 2, 3})}) {
    const Pose tip = tip_pose(base, some);
    EXPECT_EQ(tip.origin, base.origin);
    EXPECT_EQ(tip.rotation.coeffs(), base.rotation.coeffs());
  }
}

TEST(PictureOf, a_runners_snapshots) {
  Snapshot s;
  s.step.time_s = 1.5;
  s.step.base.origin = {0, 0, 0};
  s.step.hand_force_N = {9, 9, 9};
  const auto line = quarter(100.0, Snapshot::kCentreline);
  std::copy(line.begin(), line.end(), s.centreline.begin());
  DeviceSnapshot d;
  d.sent.force = {1, 2, 3};
  d.sent.torque = {4, 5, 6};
  const Picture p = picture_of(s, d);
  EXPECT_EQ(p.time_s, 1.5);
  EXPECT_EQ(p.on_hand.force, (Triple{1, 2, 3})) << "what the runner let through, not what was computed";
  EXPECT_EQ(p.on_hand.torque, (Triple{4, 5, 6}));
  EXPECT_EQ(p.shaft.front(), line.front());
  EXPECT_EQ(p.shaft.back(), line.back());
  EXPECT_EQ(p.shaft[3], line[21]);
  EXPECT_EQ(p.tip.origin, line.back());
}
