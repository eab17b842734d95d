// SPDX-License-Identifier: GPL-3.0-or-later
#include "pick_up.hpp"

#include <gtest/gtest.h>

#include <numbers>

using namespace stylet;
using namespace stylet::serve;

namespace {

/// A handle whose pose the test sets.
struct Handle final : Device {
  DeviceInput& says;
  Wrench& felt;
  Handle(DeviceInput& says_, Wrench& felt_) : says(says_), felt(felt_) {}
  [[nodiscard]] DeviceTraits traits() const override { return {.name = "handle", .force = true}; }
  DeviceInput read(const DeviceTime& /*time*/) noexcept override { return says; }
  void write(const Wrench& on_hand) noexcept override { felt = on_hand; }
};

Pose at(const Vec3& origin, double tilt_deg = 0.0, double roll_deg = 0.0) {
  const auto turn = [](double deg, const Vec3& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(deg * std::numbers::pi / 180.0, axis));
  };
  return {origin, turn(tilt_deg, Vec3::UnitX()) * turn(roll_deg, Vec3::UnitZ())};
}

struct Taken {
  DeviceInput says;
  Wrench felt;
  PickUp device{std::make_unique<Handle>(says, felt), at({1, 2, -150})};
  double now_s = 0.0;
  double simulated_s = 0.0;

  DeviceInput read(const Pose& handle, bool paused = false) {
    says = {.time_s = now_s, .valid = true, .pose = plain(handle), .buttons = 2};
    now_s += 1e-3;
    if (!paused) simulated_s += 1e-3;
    return device.read({.now_s = now_s, .simulated_s = simulated_s});
  }
};

}  // namespace

TEST(PickUp, takes_the_needle_up_at_its_start_only_and_then_follows_anywhere) {
  Taken t;
  EXPECT_FALSE(t.read(at({1, 2, -129})).valid) << "21 mm";
  ASSERT_TRUE(t.device.away());
  EXPECT_NEAR(t.device.away()->mm, 21.0, 1e-9);
  EXPECT_NEAR(t.device.away()->deg, 0.0, 1e-5);
  EXPECT_FALSE(t.read(at({1, 2, -150}, 21.0)).valid) << "21 degrees";
  EXPECT_NEAR(t.device.away()->deg, 21.0, 1e-9);
  const DeviceInput taken = t.read(at({1, 2, -131}, 19.0, 170.0));
  EXPECT_TRUE(taken.valid) << "with any roll";
  EXPECT_EQ(taken.buttons, 2u);
  EXPECT_FALSE(t.device.away());
  for (int k = 1; k <= 20; ++k) {
    const Pose far = at({1, 2, -131 + 15.0 * k}, 19.0 - 15.0 * k);
    const DeviceInput input = t.read(far);
    ASSERT_TRUE(input.valid) << k;
    EXPECT_EQ(pose(input.pose).origin, far.origin);
  }
}

TEST(PickUp, after_a_leap_or_a_pause_the_needle_waits_where_it_is) {
  Taken t;
  ASSERT_TRUE(t.read(at({1, 2, -140})).valid);
  EXPECT_FALSE(t.read(at({1, 2, -100})).valid) << "leaps";
  EXPECT_FALSE(t.read(at({1, 2, -95})).valid) << "and does not come back";
  ASSERT_TRUE(t.read(at({1, 2, -125})).valid);
  for (double z = -125.0; z <= -107.0; z += 1.0) EXPECT_TRUE(t.read(at({1, 2, z}), true).valid) << "paused";
  for (double z = -104.0; z <= -90.0; z += 1.0) EXPECT_FALSE(t.read(at({1, 2, z}), true).valid);
  EXPECT_FALSE(t.read(at({1, 2, -90})).valid) << "goes on";
  EXPECT_TRUE(t.read(at({1, 2, -120})).valid);
}

TEST(PickUp, a_handle_without_a_pose_is_not_away_and_feels_what_it_is_given) {
  Taken t;
  EXPECT_FALSE(t.read(at({0, 0, 0})).valid);
  t.says.valid = false;
  EXPECT_FALSE(t.device.read({.now_s = 1.0, .simulated_s = 1.0}).valid);
  EXPECT_FALSE(t.device.away());
  t.device.write({{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(t.felt.force, Vec3(1, 2, 3));
  EXPECT_TRUE(t.device.traits().force);
}
