// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

namespace stylet {

/// The last surface that the tip has passed. Directly behind it the cut does not lead back to it: where the tissue is
/// strained beyond the linear model, its strain differs from element to element, and may turn the cut around.
class PassedSurface {
 public:
  PassedSurface() = default;
  /// @param x [mm] LPS, where the tip passes it @param inwards LPS, its unit normal @param came LPS, unit direction of
  /// the cut that came there @param tangent LPS, unit tangent of the needle at its tip
  PassedSurface(const Vec3& x, const Vec3& inwards, const Vec3& came, const Vec3& tangent)
      : x_(x),
        inwards_(inwards),
        onwards_(came.dot(inwards) > 0.0      ? came
                 : tangent.dot(inwards) > 0.0 ? tangent
                                              : inwards) {}

  /// LPS, unit direction of the cut from x [mm] on. @param aimed that by shape and strain, of any length
  [[nodiscard]] Vec3 direction(const Vec3& x, const Vec3& aimed) const {
    const bool leads_back = (x - x_).norm() < kAway_mm && aimed.dot(inwards_) < 0.0;
    return leads_back ? onwards_ : Vec3(aimed.normalized());
  }

 private:
  /// [mm] Way behind a surface on which the cut does not lead back to it. Raised, a needle that grazes a surface stays
  /// behind it for longer; lowered, one that presses on it with many newtons may break it again and again.
  static constexpr double kAway_mm = 1.0;

  Vec3 x_ = Vec3::Zero();
  Vec3 inwards_ = Vec3::Zero();  ///< zero: no surface yet
  Vec3 onwards_ = Vec3::UnitZ();
};

}  // namespace stylet
