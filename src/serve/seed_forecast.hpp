// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <optional>

namespace stylet::serve {

/// Foretells where a seed that left the needle now would rest: the point X of the tissue with X + u(X) = place, which
/// is searched for while the needle goes on moving. Each answer of the loop improves the point by one step of
/// MaterialSearch's iteration; at a needle at rest it ends within some hundredths of a second.
class SeedForecast {
 public:
  /// Places of the seed's centre now [mm] LPS, in the room.
  struct Places {
    Vec3 place = Vec3::Zero();     ///< where the needle leaves it
    Vec3 straight = Vec3::Zero();  ///< where a rigid straight needle on the same base would leave it
  };

  /// @param now empty: the tip is not in the tissue
  void aim(const std::optional<Places>& now);
  /// The point of the tissue [mm] LPS whose present place is wanted; empty: none.
  [[nodiscard]] const std::optional<Vec3>& point() const { return x_; }
  /// Takes the present place [mm] LPS of point(). @return whether point() is another one since
  bool take(const Vec3& now);
  /// Where the seed would rest [mm] LPS; empty: not known.
  [[nodiscard]] std::optional<Vec3> rest() const;
  /// Distance of rest() from where a rigid straight needle leaves the seed in a patient that nothing has moved [mm].
  [[nodiscard]] std::optional<double> off_mm() const;

 private:
  std::optional<Places> now_;
  std::optional<Vec3> x_;
  std::optional<Vec3> off_;  ///< [mm] from where point() was to the place, at the last answer; empty: no answer
  double step_ = 1.0;        ///< share of a full step
  int unanswered_ = 0;       ///< calls of aim() since the last answer
};

}  // namespace stylet::serve
