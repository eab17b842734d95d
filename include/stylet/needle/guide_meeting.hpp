// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/needle.hpp"

namespace stylet {

/// A hole of a guide template.
struct GuideHole {
  double clearance_mm = 0.05;         ///< radius of the hole less that of the needle, ≥ 0
  double stiffness_N_per_mm = 100.0;  ///< of shaft against hole, > 0
};

/// How a shaft runs through a hole: where it crosses the hole's plane, and what the hole exerts on it there
/// (GuidedNeedle has the formula).
class GuideMeeting {
 public:
  explicit GuideMeeting(const GuideHole& hole) : hole_(hole) {}

  /// Puts the hole at `centre` [mm] LPS. @param axis LPS, towards the tip; unit vector
  void place(const Vec3& centre, const Vec3& axis);
  /// Takes the needle's present shape.
  void meet(const Needle& needle);

  /// Whether the shaft is at the hole's edge, or where there is no play, in the hole.
  [[nodiscard]] bool holds() const { return crosses_ && (beyond_ > 0.0 || hole_.clearance_mm == 0.0); }
  /// The hole's force on the needle and where it acts.
  [[nodiscard]] const PointLoad& load() const { return load_; }
  /// [N/mm] By how much that force changes as the shaft moves.
  [[nodiscard]] const Mat3& stiffness() const { return stiffness_; }
  /// [mm] Distance of the shaft from the hole's axis in its plane; 0 where it does not cross it.
  [[nodiscard]] double offset() const { return offset_.norm(); }
  /// [N mm] Elastic energy in the hole's edge.
  [[nodiscard]] double energy() const { return 0.5 * hole_.stiffness_N_per_mm * beyond_ * beyond_; }

 private:
  [[nodiscard]] bool find_crossing(const Needle& needle);

  GuideHole hole_;
  bool placed_ = false;
  Vec3 centre_ = Vec3::Zero();  ///< [mm] LPS
  Vec3 axis_ = Vec3::UnitZ();   ///< unit, LPS
  bool crosses_ = false;        ///< the shaft crosses the hole's plane
  double beyond_ = 0.0;         ///< [mm] by which it is further from the hole's axis than the clearance, ≥ 0
  Vec3 offset_ = Vec3::Zero();  ///< [mm] of the shaft from the hole, in the plane
  PointLoad load_;              ///< its place is kept where there is no crossing: the next one is near
  Mat3 stiffness_ = Mat3::Zero();
};

}  // namespace stylet
