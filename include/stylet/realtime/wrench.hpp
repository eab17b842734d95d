// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>

namespace stylet {

/// A force and a torque about the base point (or about the handle's origin).
struct Wrench {
  Vec3 force = Vec3::Zero();   ///< [N] LPS
  Vec3 torque = Vec3::Zero();  ///< [N mm] LPS

  [[nodiscard]] bool finite() const { return force.allFinite() && torque.allFinite(); }
};

/// Motion of a rigid body.
struct Twist {
  Vec3 velocity = Vec3::Zero();          ///< [mm/s] LPS, of the base point (or of the handle's origin)
  Vec3 angular_velocity = Vec3::Zero();  ///< [rad/s] LPS
};

/// Rotation vector [rad] LPS that turns `from` into `to`, at most π long.
[[nodiscard]] Vec3 rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to);
/// `from`, turned by a rotation vector [rad] LPS.
[[nodiscard]] Eigen::Quaterniond rotated(const Eigen::Quaterniond& from, const Vec3& by);

// The same quantities as plain data, for devices and displays.

using Triple = std::array<double, 3>;  ///< x, y, z as Vec3

struct PlainPose {
  Triple origin{};                             ///< [mm] LPS
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< x, y, z, w as Pose::rotation
};

struct PlainWrench {
  Triple force{};   ///< [N] LPS
  Triple torque{};  ///< [N mm] LPS
};

[[nodiscard]] inline Triple plain(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
[[nodiscard]] inline Vec3 vec3(const Triple& t) { return {t[0], t[1], t[2]}; }
[[nodiscard]] inline PlainPose plain(const Pose& p) {
  return {plain(p.origin), {p.rotation.x(), p.rotation.y(), p.rotation.z(), p.rotation.w()}};
}
[[nodiscard]] inline Pose pose(const PlainPose& p) {
  return {vec3(p.origin), Eigen::Quaterniond(p.rotation[3], p.rotation[0], p.rotation[1], p.rotation[2])};
}
[[nodiscard]] inline PlainWrench plain(const Wrench& w) { return {plain(w.force), plain(w.torque)}; }
[[nodiscard]] inline Wrench wrench(const PlainWrench& w) { return {vec3(w.force), vec3(w.torque)}; }

}  // namespace stylet
