// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <vector>

namespace stylet {

/// Pose of the needle's base at a moment.
struct MotionSample {
  double time_s = 0.0;
  Pose base;
};

/// Motion of the needle's base over time: interpolated between samples, at rest before the first and after the last.
class BaseMotion {
 public:
  BaseMotion() = default;
  explicit BaseMotion(std::vector<MotionSample> samples);  ///< times strictly increasing, at least one sample

  /// A straight motion in along `direction`, a pause, and out again if `retract`. The tip of a rigid straight needle on
  /// the base would start `approach_mm` before `entry` and reach `depth_mm` beyond it.
  /// @param entry [mm] LPS, skin point @param direction unit vector, LPS
  /// @param roll_rad rotation of the base about `direction`, relative to pose_along()
  static BaseMotion straight(const Vec3& entry, const Vec3& direction, double needle_length_mm, double approach_mm,
                             double depth_mm, double speed_mm_per_s, double dwell_s, bool retract,
                             double retract_speed_mm_per_s, double roll_rad = 0.0);

  [[nodiscard]] Pose at(double time_s) const;
  [[nodiscard]] double duration_s() const { return samples_.empty() ? 0.0 : samples_.back().time_s; }
  [[nodiscard]] const std::vector<MotionSample>& samples() const { return samples_; }

 private:
  std::vector<MotionSample> samples_;
};

/// A pose whose local z axis points along `direction` and whose local x axis is as close as possible to the patient's
/// left.
Pose pose_along(const Vec3& origin, const Vec3& direction);

}  // namespace stylet
