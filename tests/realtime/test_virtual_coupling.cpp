// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/virtual_coupling.hpp"

#include <gtest/gtest.h>

#include <numbers>

using namespace stylet;

namespace {

DeviceTraits haptic(double damping = 0.005, double damping_around = 0.5) {
  return {.name = "arm",
          .force = true,
          .torque = true,
          .damping_N_s_per_mm = damping,
          .damping_Nmm_s_per_rad = damping_around};
}

constexpr double kPeriod_s = 1e-3;

}  // namespace

TEST(VirtualCoupling, is_refused_exactly_from_where_sampling_could_feed_the_hand_on) {
  // The condition b > K T/2 + B with b = 0.005 and B = 0.001 gives K < 8 N/mm.
  VirtualCouplingSettings s;
  s.stiffness_N_per_mm = 7.99;
  ASSERT_TRUE(VirtualCoupling::create(s, haptic(), kPeriod_s).ok());
  EXPECT_NEAR(VirtualCoupling::create(s, haptic(), kPeriod_s)->spare_damping_N_s_per_mm(), 5e-6, 1e-9);
  s.stiffness_N_per_mm = 8.0;
  EXPECT_FALSE(VirtualCoupling::create(s, haptic(), kPeriod_s).ok());
  EXPECT_TRUE(VirtualCoupling::create(s, haptic(), kPeriod_s / 2).ok()) << "a shorter period bears more";
  EXPECT_TRUE(VirtualCoupling::create(s, haptic(0.0051), kPeriod_s).ok());
}

TEST(VirtualCoupling, a_refusal_names_the_values_and_what_to_do) {
  VirtualCouplingSettings s;
  s.stiffness_N_per_mm = 20.0;
  const auto refused = VirtualCoupling::create(s, haptic(), kPeriod_s);
  ASSERT_FALSE(refused.ok());
  const std::string text = refused.error().message();
  for (const char* part :
       {"translation", "20 N/mm", "0.001 N s/mm", "1 ms", "0.011 N s/mm", "arm has 0.005", "below 8 N/mm"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
}

TEST(VirtualCoupling, a_device_with_less_damping_than_asked_for_is_told_so) {
  VirtualCouplingSettings s;
  const auto refused = VirtualCoupling::create(s, haptic(0.0005), kPeriod_s);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().cure.find("a damping below the device's 0.0005"), std::string::npos)
      << refused.error().message();
}

TEST(VirtualCoupling, rotation_counts_only_where_the_hand_feels_it) {
  DeviceTraits device = haptic(0.005, 0.0);
  EXPECT_EQ(VirtualCoupling::create({}, device, kPeriod_s).error().where, "virtual coupling, rotation");
  device.torque = false;
  EXPECT_TRUE(VirtualCoupling::create({}, device, kPeriod_s).ok());
}

TEST(VirtualCoupling, numbers_that_are_no_spring_are_refused) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    VirtualCouplingSettings s;
    s.stiffness_N_per_mm = bad;
    EXPECT_FALSE(VirtualCoupling::create(s, haptic(), kPeriod_s).ok()) << bad;
    s = {};
    s.stiffness_Nmm_per_rad = bad;
    EXPECT_FALSE(VirtualCoupling::create(s, haptic(), kPeriod_s).ok()) << bad;
    EXPECT_EQ(VirtualCoupling::create({}, haptic(), bad).error().where, "virtual coupling, period");
  }
  VirtualCouplingSettings s;
  s.damping_N_s_per_mm = -1e-3;
  EXPECT_FALSE(VirtualCoupling::create(s, haptic(), kPeriod_s).ok());
}

TEST(VirtualCoupling, pulls_the_base_to_the_handle_and_damps_their_relative_motion) {
  const VirtualCouplingSettings s;
  const auto made = VirtualCoupling::create(s, haptic(), kPeriod_s);
  ASSERT_TRUE(made.ok());
  const Vec3 axis = Vec3(1, 2, 2) / 3.0;
  Pose handle{{1, 2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(0.3, axis))};
  const Pose base{{1, 2, 1}, Eigen::Quaterniond(Eigen::AngleAxisd(0.1, axis))};
  Wrench w = made->on_base(handle, {}, base, {});
  EXPECT_NEAR((w.force - Vec3(0, 0, 2.0 * s.stiffness_N_per_mm)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((w.torque - 0.2 * s.stiffness_Nmm_per_rad * axis).norm(), 0.0, 1e-10);
  handle.rotation.coeffs() *= -1.0;  // the same rotation
  EXPECT_NEAR((made->on_base(handle, {}, base, {}).torque - w.torque).norm(), 0.0, 1e-10);

  w = made->on_base(base, {{10, 0, 0}, {0, 1, 0}}, base, {{4, 0, 0}, {0, 0, 0}});
  EXPECT_NEAR((w.force - Vec3(6.0 * s.damping_N_s_per_mm, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((w.torque - Vec3(0, s.damping_Nmm_s_per_rad, 0)).norm(), 0.0, 1e-12);
}

TEST(Rotation, turning_by_the_rotation_between_two_orientations_leads_from_one_to_the_other) {
  for (int k = 0; k < 200; ++k) {
    const double angle = std::numbers::pi * (k % 20 == 0 ? 1e-12 : (k % 97) / 97.0);
    const Vec3 axis = Vec3(std::cos(k), std::sin(3.0 * k), std::cos(7.0 * k) + 0.1).normalized();
    const Eigen::Quaterniond from(Eigen::AngleAxisd(0.7 * k, axis.unitOrthogonal()));
    const Eigen::Quaterniond to = rotated(from, angle * axis);
    EXPECT_NEAR((rotation_between(from, to) - angle * axis).norm(), 0.0, 1e-13 + 1e-9 * angle) << k;
  }
}
