// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/shaft_contact.hpp"
#include "coupling/tip/tip_contact.hpp"

namespace stylet {

/// Predicts the end of a sub-step: all quantities continue as in the last sub-steps, in proportion to the base's
/// motion, by the parabola through the last three values. The prediction does not change the balance, but from it the
/// solver has to find only third differences (docs/theory/balance.md).
class Predictor {
 public:
  /// @param shape_size size of Needle::state()
  explicit Predictor(Eigen::Index shape_size);

  /// Begins a sub-step after the base has moved: stores the present values and computes the paces. Sliding contacts are
  /// moved at once, because the cut is aimed from there.
  /// @param before, now poses of the base
  void begin(const Pose& before, const Pose& now, const Needle& needle, TipContact& tip, std::span<ShaftContact> shaft);
  /// Applies the rest of the prediction after the cut has been aimed: the cut, the needle's shape and the forces.
  void go_on(Needle& needle, TipContact& tip, std::span<ShaftContact> shaft);
  /// Restores the values of the start of the sub-step.
  void go_back(Needle& needle, TipContact& tip, std::span<ShaftContact> shaft) const;
  /// Ends a sub-step.
  /// @param cut [mm] length that the tip cut in it
  /// @param steady whether it was balanced in few iterations and the tip kept its state
  void end(double cut, bool steady, const Needle& needle, TipContact& tip, std::span<ShaftContact> shaft);

  /// There was no contact in the sub-step: the next one is not predicted.
  void interrupt() { steady_ = false; }
  /// The base is moved to another place: nothing is predicted.
  void forget();

  /// Whether forces and shape of the sub-step are expected to change.
  [[nodiscard]] bool expects_forces() const { return force_.share != 0.0; }
  /// [mm] Motion of the base along its axis in the last sub-step.
  [[nodiscard]] double last_way() const { return last_way_; }
  /// [mm] Motion of the base in the last sub-step: that of its origin, combined with the motion that its rotation gives
  /// a point one needle length away.
  [[nodiscard]] double last_motion() const { return last_motion_.norm(); }
  /// [mm] LPS, the needle's tip at the start of the sub-step, with the base already at the end of it.
  [[nodiscard]] const Vec3& tip_start() const { return tip_start_; }

 private:
  Eigen::Vector<double, 6> last_motion_ = Eigen::Vector<double, 6>::Zero();
  double last_way_ = 0.0;
  double last_cut_ = 0.0;  ///< [mm] length that the tip cut in the last sub-step
  double cut_more_ = 0.0;  ///< [mm] the part of it that was not in proportion to the cut before
  Vec3 tip_start_ = Vec3::Zero();
  VecX shape_start_;   ///< Needle::state() at the start of the sub-step
  VecX shape_gained_;  ///< its change in the last sub-step
  VecX shape_more_;    ///< the part of that change that was not in proportion to the previous change
  VecX expected_;      ///< work space for a state
  Pace force_;         ///< for forces and the needle's shape
  Pace way_;           ///< for slides and the cut
  bool steady_ = false;
};

}  // namespace stylet
