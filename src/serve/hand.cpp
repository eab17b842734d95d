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

/// Depth at which a planned insertion starts [mm]; negative in front of the skin.
double start_depth(const PlannedInsertion& plan, double needle_length_mm) {
  const Pose base = plan.motion.at(0.0);
  const Vec3 tip = base.origin + needle_length_mm * (base.rotation * Vec3::UnitZ());
  return (tip - plan.entry).dot(plan.direction);
}

/// Unit vectors perpendicular to a needle, in the two directions in which a hub is tilted.
struct Sides {
  Vec3 left, anterior;
  explicit Sides(const Vec3& along)
      : left(across(along, std::abs(along.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitZ())),
        anterior(across(along, std::abs(along.y()) < 0.9 ? Vec3(-Vec3::UnitY()) : Vec3::UnitZ())) {}

 private:
  static Vec3 across(const Vec3& along, const Vec3& side) { return (side - side.dot(along) * along).normalized(); }
};

/// Orientation, without roll, of a needle that was planned along `along` and is tilted so that it lies along `axis`.
Eigen::Quaterniond tilted(const Vec3& along, const Vec3& axis) {
  return Eigen::Quaterniond::FromTwoVectors(along, axis) * pose_along(Vec3::Zero(), along).rotation;
}

}  // namespace

HandLimits hand_limits(const Scenario& scenario) {
  HandLimits limits;
  limits.depth_mm = deepest_mm(scenario);
  return limits;
}

Pose hand_pose(const HandTarget& hand, const PlannedInsertion& plan, double needle_length_mm) {
  const Vec3& along = plan.direction;
  const Sides sides(along);
  // When the hub is tilted to one side, the tip moves to the other side.
  const Vec3 axis = (along - std::tan(hand.tilt_left_deg * kRadians) * sides.left -
                     std::tan(hand.tilt_anterior_deg * kRadians) * sides.anterior)
                        .normalized();
  const Eigen::Quaterniond roll(Eigen::AngleAxisd(hand.roll_deg * kRadians, Vec3::UnitZ()));
  return {plan.entry + (hand.depth_mm - needle_length_mm) * axis, (tilted(along, axis) * roll).normalized()};
}

HandTarget hand_angles(const Pose& base, const PlannedInsertion& plan) {
  const Vec3& along = plan.direction;
  const Vec3 axis = base.rotation * Vec3::UnitZ();
  const double forward = axis.dot(along);
  HandTarget hand;
  if (forward > 0.0) {
    // axis ∝ along − a·left − b·anterior. The two sides need not be perpendicular, so a and b solve a 2 × 2 system.
    const Sides sides(along);
    const double both = sides.left.dot(sides.anterior);
    const double left = -axis.dot(sides.left) / forward;
    const double anterior = -axis.dot(sides.anterior) / forward;
    const double apart = 1.0 - both * both;
    constexpr double kOneSide = 1e-6;  // below this, left and anterior coincide and the whole tilt is called left
    hand.tilt_left_deg = std::atan(apart < kOneSide ? left : (left - both * anterior) / apart) / kRadians;
    hand.tilt_anterior_deg = std::atan(apart < kOneSide ? 0.0 : (anterior - both * left) / apart) / kRadians;
  }
  const Eigen::Quaterniond roll = tilted(along, axis).conjugate() * base.rotation;
  hand.roll_deg = std::remainder(2.0 * std::atan2(roll.z(), roll.w()) / kRadians, 360.0);
  return hand;
}

PageDevice::PageDevice(const PlannedInsertion& plan, const Scenario& scenario)
    : plan_(plan), needle_length_mm_(scenario.needle.length_mm), limits_(hand_limits(scenario)) {
  now_.depth_mm = start_depth(plan, needle_length_mm_);
  now_.roll_deg = hand_angles(plan.motion.at(0.0), plan).roll_deg;
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
