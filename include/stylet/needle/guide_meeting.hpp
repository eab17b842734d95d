// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/needle.hpp"

namespace stylet {

/// A hole of a guide template.
struct GuideHole {
  double clearance_mm = 0.05;         ///< [mm] radius of the hole − radius of the needle, ≥ 0
  double stiffness_N_per_mm = 100.0;  ///< [N/mm] stiffness of the contact between shaft and edge, > 0
};

/// Contact of a shaft with a hole: the point of the shaft that is nearest to the hole's centre, and the force of the
/// hole on it there (formula: GuidedNeedle).
class GuideMeeting {
 public:
  explicit GuideMeeting(const GuideHole& hole) : hole_(hole) {}

  /// Places the hole.
  /// @param centre [mm] LPS
  /// @param axis unit vector LPS, towards the tip
  void place(const Vec3& centre, const Vec3& axis);
  /// Computes the nearest point, force and stiffness for the current shape of the needle.
  void meet(const Needle& needle);

  /// Whether the hole exerts a force: the shaft touches its edge, or is in it where there is no clearance.
  [[nodiscard]] bool holds() const { return found_ && (push_ > 0.0 || hole_.clearance_mm == 0.0); }
  /// Whether it has exerted one since the shaft has been in it. From then on its load is one of the tangent's, so that
  /// no new tangent is needed whenever the shaft touches the edge.
  [[nodiscard]] bool has_held() const { return has_held_; }
  /// Force of the hole on the needle and the arc length where it acts.
  [[nodiscard]] const PointLoad& load() const { return load_; }
  /// [N/mm] Tangent stiffness: minus the derivative of load() with respect to the position of the shaft. The effect of
  /// the shaft's rotation is neglected.
  [[nodiscard]] const Mat3& stiffness() const { return stiffness_; }
  /// [mm] Distance between the shaft and the hole's centre; 0 where the shaft is not in the hole.
  [[nodiscard]] double offset() const { return offset_.norm(); }
  /// [N mm] Elastic energy of the contact.
  [[nodiscard]] double energy() const { return energy_; }

 private:
  [[nodiscard]] bool find_nearest(const Needle& needle);

  GuideHole hole_;
  bool placed_ = false;
  Vec3 centre_ = Vec3::Zero();  ///< [mm] LPS
  Vec3 axis_ = Vec3::UnitZ();   ///< unit, LPS
  bool found_ = false;          ///< whether the shaft is in the hole
  bool has_held_ = false;       ///< whether it has held the shaft since
  double push_ = 0.0;           ///< [N] force of the edge on the shaft
  double energy_ = 0.0;         ///< [N mm]
  Vec3 offset_ = Vec3::Zero();  ///< [mm] vector from the hole's centre to the shaft, perpendicular to it
  PointLoad load_;              ///< force of the hole and the place of the nearest point
  Mat3 stiffness_ = Mat3::Zero();
};

}  // namespace stylet
