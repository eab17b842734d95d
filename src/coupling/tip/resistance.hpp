// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/laws.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

/// The resistance ahead of the tip: tissue that it cuts, or a surface that has to break first.
class Resistance {
 public:
  /// [N] Axial force on the tissue at which the cut begins; infinite at bone.
  [[nodiscard]] double limit() const { return limit_; }
  /// [N] Axial force of a cut that continues slowly.
  [[nodiscard]] double cutting() const { return cutting_; }
  /// The region that is cut; −1 before the first one is met.
  [[nodiscard]] int region() const { return region_; }
  /// [N] cutting() by the built-in law: the region's own cutting force.
  [[nodiscard]] double built_in_cutting() const { return built_in_cutting_; }
  /// Whether an unbroken surface is ahead.
  [[nodiscard]] bool is_surface() const { return surface_; }
  [[nodiscard]] bool is_bone() const { return std::isinf(limit_); }
  /// Element behind the surface that was met last, −1: the outside of the patient.
  [[nodiscard]] Index behind() const { return behind_; }

  /// Sets tissue of a region ahead.
  void be_tissue(int region, double cutting_N) {
    surface_ = false;
    region_ = region;
    limit_ = cutting_ = built_in_cutting_ = cutting_N;
  }
  /// Replaces the cutting force of the region by that of another law.
  void set_cutting(double cutting_N) {
    cutting_ = cutting_N;
    if (!surface_) limit_ = cutting_N;
  }
  /// Sets the patient's outer surface ahead, seen from outside. @param inwards unit normal, LPS @param break_N force
  /// that breaks it
  void be_outer_surface(Index behind, int region, const Vec3& inwards, double break_N, double cutting_N) {
    be_surface(behind, break_N);
    region_ = region;
    inwards_ = inwards;
    cutting_ = built_in_cutting_ = cutting_N;
    limit_ = std::max(break_N, cutting_N);
  }
  /// Sets a surface within the patient ahead; cutting() stays that of the tissue before it.
  void be_surface(Index behind, double break_N) {
    surface_ = true;
    behind_ = behind;
    inwards_.setZero();
    limit_ = break_N;
  }
  /// Sets the surface that was met behind the tip.
  void pass(Index behind) {
    surface_ = false;
    behind_ = behind;
  }

  /// Whether a surface is ahead that breaks under an axial force [N] of a tip with the unit tangent t. A tip that lies
  /// flat to the patient's surface does not break it, just as a tip that meets it flat does not enter.
  /// @param grazing_cos cosine of the angle between tangent and normal below which the tip lies flat
  [[nodiscard]] bool gives(double axial, const Vec3& t, double grazing_cos) const {
    return surface_ && axial > limit_ && !is_flat(t, grazing_cos);
  }
  /// Whether a tip with the unit tangent t lies flat to the patient's surface ahead. It then slides off.
  [[nodiscard]] bool is_flat(const Vec3& t, double grazing_cos) const {
    return surface_ && !inwards_.isZero() && inwards_.dot(t) < grazing_cos;
  }

 private:
  double limit_ = 0.0;
  double cutting_ = 0.0;
  double built_in_cutting_ = 0.0;
  bool surface_ = false;
  int region_ = -1;
  Index behind_ = -1;
  Vec3 inwards_ = Vec3::Zero();  ///< normal of the patient's outer surface; zero for a surface within the patient
};

}  // namespace stylet
