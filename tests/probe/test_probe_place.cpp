// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/probe_place.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <numbers>
#include <random>

namespace stylet {
namespace {

const ProbeSeat kSeat{{1.0, 40.0, -60.0}, 5.0};

TEST(ProbePlace, at_rest_is_along_the_patient_and_looks_anterior) {
  const ProbePlace place = probe_place({.kind = ProbeKind::biplane}, kSeat);
  EXPECT_LT((place.origin_mm - Vec3(1.0, 40.0, 5.0)).norm(), 1e-12);
  EXPECT_LT((place.axes.col(1) + Vec3::UnitY()).norm(), 1e-12) << "anterior is −y";
  EXPECT_LT((place.axes.col(2) - Vec3::UnitZ()).norm(), 1e-12) << "superior is +z";
  EXPECT_NEAR(place.axes.determinant(), 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(place.radius_mm, 10.0);
}

TEST(ProbePlace, the_stepper_moves_it_as_its_names_say) {
  EXPECT_LT(probe_place({.lift_mm = 8.0}, kSeat).origin_mm.y(), 33.0) << "a lift is anterior";
  EXPECT_GT(probe_place({.tilt_deg = 5.0}, kSeat).axes.col(2).dot(-Vec3::UnitY()), 0.0) << "the end goes anterior";
  EXPECT_GT(probe_place({.roll_deg = 20.0}, kSeat).axes.col(1).x(), 0.3) << "the picture turns to the patient's left";
  const ProbePlace balloon = probe_place({.balloon_mm = 3.0, .depth_mm = 20.0}, kSeat);
  EXPECT_DOUBLE_EQ(balloon.radius_mm, 13.0);
  EXPECT_DOUBLE_EQ(balloon.origin_mm.z(), 20.0);
}

/// Every pose that a stepper reaches is found again from its motions, over the ranges of the keys of [probe].
TEST(StepperMotions, of_a_reachable_place_give_this_place) {
  std::mt19937 random(7);
  const auto within = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (int k = 0; k < 2000; ++k) {
    ProbeSettings settings{.depth_mm = within(-100, 100)};
    settings.lift_mm = within(-30, 30);
    settings.tilt_deg = within(-30, 30);
    settings.roll_deg = within(-180, 180);
    const Pose pose = pose_of(probe_place(settings, kSeat));
    const StepperMotions found = stepper_motions(pose, kSeat);
    EXPECT_NEAR(found.depth_mm, *settings.depth_mm, 1e-9);
    EXPECT_NEAR(found.lift_mm, settings.lift_mm, 1e-9);
    EXPECT_NEAR(found.tilt_deg, settings.tilt_deg, 1e-9);
    EXPECT_NEAR(found.roll_deg, settings.roll_deg, 1e-9);
    EXPECT_NEAR(found.aside_mm, 0.0, 1e-9);
    EXPECT_NEAR(found.turned_deg, 0.0, 1e-6);
    ProbeSettings again{.depth_mm = found.depth_mm};
    again.lift_mm = found.lift_mm;
    again.tilt_deg = found.tilt_deg;
    again.roll_deg = found.roll_deg;
    const Pose there = pose_of(probe_place(again, kSeat));
    EXPECT_LT((there.origin - pose.origin).norm(), 1e-9);
    EXPECT_LT(there.rotation.angularDistance(pose.rotation), 1e-9);
  }
}

TEST(StepperMotions, of_a_free_pose_leave_out_the_two_that_a_stepper_lacks) {
  const ProbeSettings settings{.depth_mm = 12.0, .lift_mm = 6.0, .tilt_deg = 4.0};
  const Pose pose = pose_of(probe_place(settings, kSeat));
  // Beside the plane of the stepper, to the patient's left.
  const StepperMotions beside = stepper_motions({pose.origin + 7.0 * Vec3::UnitX(), pose.rotation}, kSeat);
  EXPECT_NEAR(beside.aside_mm, 7.0, 1e-12);
  EXPECT_NEAR(beside.turned_deg, 0.0, 1e-6);
  EXPECT_NEAR(beside.depth_mm, 12.0, 1e-9);
  EXPECT_NEAR(beside.lift_mm, 6.0, 1e-9);
  // The end to the patient's left: a positive turn about the patient's y takes +z to +x.
  constexpr double five = 5.0 * std::numbers::pi / 180.0;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(five, Vec3::UnitY()));
  const StepperMotions turned =
      stepper_motions({kSeat.anus_mm + 65.0 * (turn * Vec3::UnitZ()),
                       turn * pose_of(probe_place({.kind = ProbeKind::biplane}, kSeat)).rotation},
                      kSeat);
  EXPECT_NEAR(turned.turned_deg, 5.0, 1e-9);
  EXPECT_NEAR(turned.tilt_deg, 0.0, 1e-9);
  EXPECT_NEAR(turned.roll_deg, 0.0, 1e-9);
  EXPECT_NEAR(turned.lift_mm, 0.0, 1e-9);
}

}  // namespace
}  // namespace stylet
