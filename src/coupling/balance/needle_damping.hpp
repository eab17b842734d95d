// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// Chooses the damping of the needle's bending in a sub-step, as a time constant. A needle that is pushed beyond its
/// buckling load snaps into another shape, and on the way there is no balance at rest: what happens is a motion, whose
/// duration is that of the needle's lowest vibration, some milliseconds. Damping turns it into a motion in which each
/// sub-step has a balance. It acts while the tip stands on bone, and in parts of a sub-step that has no balance as a
/// whole. At the moment when the tip strikes bone the damping is zero and then grows, because otherwise the force would
/// overshoot.
class NeedleDamping {
 public:
  /// @param most_s [s] damping of a needle that snaps, and of one whose tip has been on bone for long
  explicit NeedleDamping(double most_s) : most_s_(most_s) {}

  /// The damping in a sub-step [s]. @param h [s] its length @param on_bone whether the tip is on bone
  /// @param in_parts whether it is a part of a sub-step without a balance
  [[nodiscard]] double in_step(double h, bool on_bone, bool in_parts) const;
  /// Ends a sub-step. @param balanced whether its balance was found
  void end(double h, bool on_bone, bool balanced) {
    on_bone_for_s_ = on_bone ? on_bone_for_s_ + h : 0.0;
    balanced_ = balanced;
  }
  /// The needle is out of the tissue.
  void forget() {
    on_bone_for_s_ = 0.0;
    balanced_ = true;
  }

  [[nodiscard]] bool balanced() const { return balanced_; }  ///< whether the last sub-step was balanced

 private:
  double most_s_;
  double on_bone_for_s_ = 0.0;  ///< time on bone without a break
  bool balanced_ = true;
};

}  // namespace stylet
