// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <algorithm>
#include <limits>

namespace stylet {

/// The search for the length of cut that balances. An iteration at the length a proposes the length p(a); wanted is
/// p(a) = a. The lengths follow the secant through the last two iterations, and stay between the longest cut that was
/// found too short and the shortest one that was found too long.
class CutSearch {
 public:
  /// Element that the cut has gone back out of in this balance; −1: none.
  Index left_tet = -1;

  /// Begins the search for another balance.
  void begin() { *this = {}; }
  /// Begins anew in the same balance: what is proposed at a length has changed.
  void forget() {
    const Index left = left_tet;
    *this = {};
    left_tet = left;
  }

  /// The next length to try [mm]. @param at the present one @param proposed what was found there
  double next(double at, double proposed) {
    const double more = proposed - at;
    if (more > 0.0) {
      too_short_ = at;
    } else {
      too_long_ = at;
    }
    double next = proposed;
    if (last_at_ >= 0.0 && at != last_at_) {
      const double slope = (proposed - last_proposed_) / (at - last_at_);
      next = at + more / std::max(1.0 - slope, 1.0 / kFurthest);
    }
    last_at_ = at;
    last_proposed_ = proposed;
    const bool outside = !(next > too_short_) || !(next < too_long_);
    if (outside && too_short_ >= 0.0 && too_long_ < std::numeric_limits<double>::infinity())
      next = 0.5 * (too_short_ + too_long_);
    return next > 0.0 ? next : 0.0;
  }

 private:
  /// Largest step over the one that was proposed. Raised, lengths that approach their end slowly are found sooner, and
  /// a cut may go astray where the proposals make no sense.
  static constexpr double kFurthest = 10.0;
  double last_at_ = -1.0;
  double last_proposed_ = 0.0;
  double too_short_ = -1.0;
  double too_long_ = std::numeric_limits<double>::infinity();
};

}  // namespace stylet
