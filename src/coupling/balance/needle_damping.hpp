// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// Chooses the damping of the needle's bending in a sub-step, as a time constant. Between hand and bone a needle bows
/// until it finds another shape all at once, or snaps off: on the way there is no balance. Damping makes that a motion,
/// each step of which has one. When the tip strikes bone there is none yet, or the force would overshoot. Where a
/// balance was not found all the same, damping grows until the needle hardly changes its shape and there is one, and
/// wears off again.
class NeedleDamping {
 public:
  /// @param on_bone_s [s] of a needle whose tip has stood on bone for long
  explicit NeedleDamping(double on_bone_s) : most_s_(on_bone_s) {}

  /// Damping of the sub-step that begins [s]. @param h [s] its length @param on_bone whether the tip stands on bone
  [[nodiscard]] double begin(double h, bool on_bone);
  /// A sub-step is over. @param balanced whether its balance was found
  void end(bool balanced) { balanced_ = balanced; }
  /// The needle is out: nothing is damped.
  void forget();

  [[nodiscard]] bool balanced() const { return balanced_; }  ///< the last sub-step

 private:
  double most_s_;
  double on_bone_for_s_ = 0.0;  ///< without a break
  double rescue_s_ = 0.0;       ///< damping since a balance was not found
  bool balanced_ = true;
};

}  // namespace stylet
