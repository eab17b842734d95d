// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <vector>

namespace stylet {

/// Swelling of tissue around the sources (oedema). It carries tissue and sources away from a centre, each axis by its
/// own factor 1 + s 2^(−t / half-life), and so makes the dose smaller while it lasts.
struct Swelling {
  Vec3 centre_mm = Vec3::Zero();  ///< [mm] LPS, the point that does not move
  Vec3 at_start = Vec3::Zero();   ///< s, increase of the width along x, y and z at the implantation; 0.1 for 10 %
  double half_life_days = 9.3;    ///< [d] > 0

  [[nodiscard]] bool is_any() const { return !at_start.isZero(0.0); }
  /// Factors of the widths after `days`. @param days [d] ≥ 0
  [[nodiscard]] Vec3 factors(double days) const;
  /// Place [mm] LPS of a point of the tissue with these factors.
  [[nodiscard]] Vec3 moved(const Vec3& x, const Vec3& factors) const {
    return centre_mm + factors.cwiseProduct(x - centre_mm);
  }
};

/// A part of the time of an implant, during which the swelling is taken as constant.
struct SwollenTime {
  double share = 1.0;           ///< share of the dose that would be given in this part without swelling; all sum to 1
  Vec3 factors = Vec3::Ones();  ///< mean factors of the widths in this part, weighted by the sources' decay
};

/// The parts of a permanent implant's time, with equal shares. Without swelling there is one.
/// @param half_life_days of the sources [d] @param days how long the dose is counted [d]; infinity: until all is
/// decayed
std::vector<SwollenTime> swollen_times(const Swelling& swelling, double half_life_days, double days);

}  // namespace stylet
