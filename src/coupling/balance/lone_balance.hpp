// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/resting_hold.hpp"

namespace stylet {

/// Balances the needle that the hand moves alone, while those at rest follow (RestingHold).
class LoneBalance {
 public:
  /// @param all the parts of the balance of all needles @param whole that balance; outlives this
  /// @param needle the moved one @param points largest number of points of the compliance
  LoneBalance(const BalanceParts& all, CoupledBalance& whole, Needle& needle, int points);

  /// Balances a sub-step of h seconds after the base has moved.
  /// @param damping of the needle (Needle::damp())
  /// @return whether there is a balance; if not, everything but a surface that broke is as before, and all needles have
  /// to be balanced together
  [[nodiscard]] bool solve(const Pose& from, const Pose& to, double h, double damping, Step& step);
  /// Ends a sub-step after solve(). @param cut [mm] length of the cut in it
  void end(double cut);

  /// All needles have been balanced together in a sub-step of h seconds.
  void balanced(double h, bool found) { hold_.balanced(h, found); }
  /// Whether the balance before the last one was that of the moved needle alone; the last one was not.
  [[nodiscard]] bool gives_way() { return std::exchange(was_last_, false); }
  /// Writes the present forces to the contacts at rest.
  void settle() { hold_.settle(); }
  /// The same for those who look at them between sub-steps; the next sub-step does not depend on it.
  void show() { hold_.show(); }
  /// The needle's shape was changed from outside.
  void forget_tangent() { balance_.forget_tangent(); }
  /// There was no contact in the sub-step: the next one is not predicted.
  void interrupt() { predictor_.interrupt(); }
  /// The needle is at another place.
  void forget() {
    hold_.settle();
    predictor_.forget();
  }
  /// The needle has left the tissue.
  void release() {
    hold_.settle();
    balance_.release();
  }

 private:
  [[nodiscard]] bool find(double h, Step& step);

  CoupledBalance& whole_;
  Contacts contacts_;  ///< of the moved needle
  Predictor predictor_;
  CoupledBalance balance_;
  RestingHold hold_;
  bool was_last_ = false;  ///< whether the last balance was found here
  bool steady_ = false;    ///< CoupledBalance::solve() of the last balance
};

}  // namespace stylet
