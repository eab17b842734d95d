// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cmath>

namespace stylet {

/// The own yield of a contact: D = lateral I + (axial − lateral) t tᵀ.
struct Yield {
  Vec3 along = Vec3::UnitZ();  ///< t, unit vector in LPS; zero: the same in all directions, at the tip only
  double lateral = 0.0;        ///< [mm/N] across t
  double axial = 0.0;          ///< [mm/N] along t

  [[nodiscard]] Vec3 of(const Vec3& force) const {
    return lateral * force + ((axial - lateral) * along.dot(force)) * along;
  }

  /// In direction k of frame_along(along) [mm/N]: 0 and 1 lie across t, 2 along it.
  [[nodiscard]] double component(int k) const { return k == 2 ? axial : lateral; }
};

/// Frame with two unit vectors perpendicular to t, and t itself, as columns. @param t unit vector
[[nodiscard]] inline Mat3 frame_along(const Vec3& t) {
  const Vec3 helper = std::abs(t.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  Mat3 frame;
  frame.col(0) = t.cross(helper).normalized();
  frame.col(1) = t.cross(frame.col(0));
  frame.col(2) = t;
  return frame;
}

}  // namespace stylet
