// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// Chooses the damping of the needle's bending in a sub-step, as a time constant. Between hand and bone a needle bows
/// until it snaps into another shape or off the bone, and on the way there is no balance. Damping turns the snap into a
/// motion in which each step has a balance. At the moment when the tip strikes bone the damping is zero and then grows,
/// because otherwise the force would overshoot. After a balance that was not found, damping grows until the needle
/// hardly changes its shape and a balance is found, and then it decays.
class NeedleDamping {
 public:
  /// @param on_bone_s [s] damping of a needle whose tip has been on bone for long
  explicit NeedleDamping(double on_bone_s) : most_s_(on_bone_s) {}

  /// Returns the damping of the next sub-step [s]. @param h [s] its length @param on_bone whether the tip is on bone
  [[nodiscard]] double begin(double h, bool on_bone);
  /// Ends a sub-step. @param balanced whether its balance was found
  void end(bool balanced) { balanced_ = balanced; }
  /// Resets the damping to zero; the needle is out of the tissue.
  void forget();

  [[nodiscard]] bool balanced() const { return balanced_; }  ///< whether the last sub-step was balanced

 private:
  double most_s_;
  double on_bone_for_s_ = 0.0;  ///< time on bone without a break
  double rescue_s_ = 0.0;       ///< damping after balances that were not found
  bool balanced_ = true;
};

}  // namespace stylet
