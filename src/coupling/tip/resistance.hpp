// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/laws.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

/// What is ahead of the tip and resists it: tissue that it cuts, or a surface that has to break first.
class Resistance {
 public:
  /// [N] Axial force on the tissue that starts the cut; infinite before bone.
  [[nodiscard]] double limit() const { return limit_; }
  /// [N] Axial force that keeps the cut going.
  [[nodiscard]] double cutting() const { return cutting_; }
  /// The region that is cut; −1 before the first one is met.
  [[nodiscard]] int region() const { return region_; }
  /// [N] The same force by the built-in law: the region's own.
  [[nodiscard]] double built_in_cutting() const { return built_in_cutting_; }
  /// Whether a surface that has not been broken is ahead.
  [[nodiscard]] bool is_surface() const { return surface_; }
  [[nodiscard]] bool is_bone() const { return std::isinf(limit_); }
  /// Element behind the surface that was met last, −1 = the outside of the patient.
  [[nodiscard]] Index behind() const { return behind_; }

  /// Tissue of a region is ahead.
  void be_tissue(int region, double cutting_N) {
    surface_ = false;
    region_ = region;
    limit_ = cutting_ = built_in_cutting_ = cutting_N;
  }
  /// Another law of cutting applies from here on.
  void set_cutting(double cutting_N) {
    cutting_ = cutting_N;
    if (!surface_) limit_ = cutting_N;
  }
  /// The patient's surface is ahead, seen from outside. @param inwards unit normal, LPS @param break_N force that
  /// breaks it
  void be_outer_surface(Index behind, int region, const Vec3& inwards, double break_N, double cutting_N) {
    be_surface(behind, break_N);
    region_ = region;
    inwards_ = inwards;
    cutting_ = built_in_cutting_ = cutting_N;
    limit_ = std::max(break_N, cutting_N);
  }
  /// A surface within the patient is ahead; before it the force that keeps a cut going is what it was.
  void be_surface(Index behind, double break_N) {
    surface_ = true;
    behind_ = behind;
    inwards_.setZero();
    limit_ = break_N;
  }
  /// The surface that was met is behind the tip.
  void pass(Index behind) {
    surface_ = false;
    behind_ = behind;
  }

  /// Whether a surface is ahead that bears less than an axial force [N] of a tip with the unit tangent t. A tip that
  /// has come to lie flat to the patient's surface does not enter, as one that meets it flat does not.
  /// @param grazing_cos cosine of the angle between tangent and normal from which on the tip lies flat
  [[nodiscard]] bool gives(double axial, const Vec3& t, double grazing_cos) const {
    if (!surface_) return false;
    const bool flat = !inwards_.isZero() && inwards_.dot(t) < grazing_cos;
    return axial > limit_ && !flat;
  }

 private:
  double limit_ = 0.0;
  double cutting_ = 0.0;
  double built_in_cutting_ = 0.0;
  bool surface_ = false;
  int region_ = -1;
  Index behind_ = -1;
  Vec3 inwards_ = Vec3::Zero();  ///< normal of the patient's surface, zero for a surface within the patient
};

}  // namespace stylet
