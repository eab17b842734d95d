// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/needle.hpp"

namespace stylet {

/// A hole of a guide template.
struct GuideHole {
  double clearance_mm = 0.05;         ///< [mm] radius of the hole − radius of the needle, ≥ 0
  double stiffness_N_per_mm = 100.0;  ///< [N/mm] stiffness of the contact between shaft and edge, > 0
};

/// Contact of a shaft with a hole: where the shaft crosses the hole's plane, and the force of the hole on it there
/// (formula: GuidedNeedle).
class GuideMeeting {
 public:
  explicit GuideMeeting(const GuideHole& hole) : hole_(hole) {}

  /// Places the hole.
  /// @param centre [mm] LPS
  /// @param axis unit vector LPS, towards the tip
  void place(const Vec3& centre, const Vec3& axis);
  /// Computes crossing, force and stiffness for the current shape of the needle.
  void meet(const Needle& needle);

  /// Whether the hole exerts a force: the shaft touches its edge, or crosses its plane where there is no clearance.
  [[nodiscard]] bool holds() const { return crosses_ && (beyond_ > 0.0 || hole_.clearance_mm == 0.0); }
  /// Force of the hole on the needle and the arc length where it acts.
  [[nodiscard]] const PointLoad& load() const { return load_; }
  /// [N/mm] Tangent stiffness: minus the derivative of load() with respect to the position of the shaft. The effect of
  /// the shaft's rotation is neglected.
  [[nodiscard]] const Mat3& stiffness() const { return stiffness_; }
  /// [mm] Distance between the shaft and the hole's axis, in its plane; 0 where the shaft does not cross the plane.
  [[nodiscard]] double offset() const { return offset_.norm(); }
  /// [N mm] Elastic energy of the contact.
  [[nodiscard]] double energy() const { return 0.5 * hole_.stiffness_N_per_mm * beyond_ * beyond_; }

 private:
  [[nodiscard]] bool find_crossing(const Needle& needle);

  GuideHole hole_;
  bool placed_ = false;
  Vec3 centre_ = Vec3::Zero();  ///< [mm] LPS
  Vec3 axis_ = Vec3::UnitZ();   ///< unit, LPS
  bool crosses_ = false;        ///< whether the shaft crosses the hole's plane
  double beyond_ = 0.0;         ///< [mm] max(0, distance of the shaft from the axis − clearance)
  Vec3 offset_ = Vec3::Zero();  ///< [mm] vector in the plane from the hole's centre to the shaft
  PointLoad load_;              ///< without a crossing, s keeps its last value: the next crossing is near it
  Mat3 stiffness_ = Mat3::Zero();
};

}  // namespace stylet
