// SPDX-License-Identifier: GPL-3.0-or-later
#include "hand.hpp"

#include "stylet/sim/plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::serve {

namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

double towards(double from, double to, double most) { return from + std::clamp(to - from, -most, most); }

/// A planned insertion starts so far before the skin.
double start_depth(const PlannedInsertion& plan, double needle_length_mm) {
  const Pose base = plan.motion.at(0.0);
  const Vec3 tip = base.origin + needle_length_mm * (base.rotation * Vec3::UnitZ());
  return (tip - plan.entry).dot(plan.direction);
}

/// Roll of a pose against pose_along() [degrees].
double roll_of(const Pose& base, const Vec3& direction) {
  const Vec3 x = pose_along(base.origin, direction).rotation.conjugate() * (base.rotation * Vec3::UnitX());
  return std::atan2(x.y(), x.x()) / kRadians;
}

}  // namespace

HandLimits hand_limits(const Scenario& scenario) {
  HandLimits limits;
  limits.depth_mm = deepest_mm(scenario);
  return limits;
}

Pose hand_pose(const HandTarget& hand, const PlannedInsertion& plan, double needle_length_mm) {
  const Vec3& along = plan.direction;
  const auto across = [&](const Vec3& side) { return Vec3(side - side.dot(along) * along).normalized(); };
  // The tip's end goes the other way than the hub.
  const Vec3 left = across(std::abs(along.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitZ());
  const Vec3 anterior = across(std::abs(along.y()) < 0.9 ? Vec3(-Vec3::UnitY()) : Vec3::UnitZ());
  const Vec3 axis =
      (along - std::tan(hand.tilt_left_deg * kRadians) * left - std::tan(hand.tilt_anterior_deg * kRadians) * anterior)
          .normalized();
  Pose pose = pose_along(plan.entry + (hand.depth_mm - needle_length_mm) * axis, along);
  const Eigen::Quaterniond roll(Eigen::AngleAxisd(hand.roll_deg * kRadians, Vec3::UnitZ()));
  pose.rotation = (Eigen::Quaterniond::FromTwoVectors(along, axis) * pose.rotation * roll).normalized();
  return pose;
}

PageDevice::PageDevice(const PlannedInsertion& plan, const Scenario& scenario)
    : plan_(plan), needle_length_mm_(scenario.needle.length_mm), limits_(hand_limits(scenario)) {
  now_.depth_mm = start_depth(plan, needle_length_mm_);
  now_.roll_deg = roll_of(plan.motion.at(0.0), plan.direction);
  now_.rest = true;
  target_.write(now_);
  shown_.write(now_);
}

DeviceInput PageDevice::read(const DeviceTime& time) noexcept {
  const double dt = std::max(0.0, time.simulated_s - last_s_);
  last_s_ = time.simulated_s;
  target_.fetch();
  if (const HandTarget& to = target_.value(); !to.rest) {
    const double speed = std::min(to.speed_mm_per_s, limits_.speed_mm_per_s);
    now_.depth_mm = towards(now_.depth_mm, std::clamp(to.depth_mm, -limits_.behind_mm, limits_.depth_mm), speed * dt);
    now_.roll_deg = towards(now_.roll_deg, std::clamp(to.roll_deg, -3600.0, 3600.0), limits_.turn_deg_per_s * dt);
    const auto tilt = [&](double from, double wanted) {
      return towards(from, std::clamp(wanted, -limits_.tilt_deg, limits_.tilt_deg), limits_.tilt_deg_per_s * dt);
    };
    now_.tilt_left_deg = tilt(now_.tilt_left_deg, to.tilt_left_deg);
    now_.tilt_anterior_deg = tilt(now_.tilt_anterior_deg, to.tilt_anterior_deg);
  }
  shown_.write(now_);
  return {.time_s = time.now_s, .valid = true, .pose = plain(hand_pose(now_, plan_, needle_length_mm_)), .buttons = 0};
}

}  // namespace stylet::serve
