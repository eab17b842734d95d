// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/motion.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

Pose pose_along(const Vec3& origin, const Vec3& direction) {
  const Vec3 z = direction.normalized();
  Vec3 x = Vec3::UnitX() - z.x() * z;
  if (x.norm() < 1e-3) x = Vec3::UnitY() - z.y() * z;
  x.normalize();
  Mat3 axes;
  axes << x, z.cross(x), z;
  return {origin, Eigen::Quaterniond(axes)};
}

BaseMotion::BaseMotion(std::vector<MotionSample> samples) : samples_(std::move(samples)) {}

BaseMotion BaseMotion::straight(const Vec3& entry, const Vec3& direction, double needle_length_mm, double approach_mm,
                                double depth_mm, double speed_mm_per_s, double dwell_s, bool retract,
                                double retract_speed_mm_per_s, double roll_rad) {
  const Vec3 along = direction.normalized();
  const auto pose = [&](double depth) {
    Pose at = pose_along(entry + (depth - needle_length_mm) * along, along);
    at.rotation = at.rotation * Eigen::AngleAxisd(roll_rad, Vec3::UnitZ());
    return at;
  };
  std::vector<MotionSample> samples{{0.0, pose(-approach_mm)}};
  const double way = approach_mm + depth_mm;
  samples.push_back({way / speed_mm_per_s, pose(depth_mm)});
  if (dwell_s > 0.0) samples.push_back({samples.back().time_s + dwell_s, pose(depth_mm)});
  if (retract) samples.push_back({samples.back().time_s + way / retract_speed_mm_per_s, pose(-approach_mm)});
  return BaseMotion(std::move(samples));
}

Pose BaseMotion::at(double time_s) const {
  if (samples_.empty()) return {};
  const auto next = std::upper_bound(samples_.begin(), samples_.end(), time_s,
                                     [](double t, const MotionSample& s) { return t < s.time_s; });
  if (next == samples_.begin()) return samples_.front().base;
  if (next == samples_.end()) return samples_.back().base;
  const MotionSample& a = *(next - 1);
  const MotionSample& b = *next;
  const double f = (time_s - a.time_s) / (b.time_s - a.time_s);
  return {a.base.origin + f * (b.base.origin - a.base.origin), a.base.rotation.slerp(f, b.base.rotation)};
}

}  // namespace stylet
