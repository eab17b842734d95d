// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/shaft_contact.hpp"
#include "coupling/tip/tip_contact.hpp"

namespace stylet {

/// Where a sub-step will probably end: everything goes on as in the last one, in proportion to the base's motion, and
/// changes its pace as it did then. The shape that the balance is solved from does not change the balance, but from
/// there the solver has only third differences to find (docs/theory/coupling.md §4).
class Predictor {
 public:
  /// @param shape_size of Needle::state()
  explicit Predictor(Eigen::Index shape_size);

  /// A sub-step begins, the base having moved: remembers where everything is, and finds the paces. Contacts that slide
  /// go on at once, since the cut is aimed from there.
  /// @param before, now poses of the base
  void begin(const Pose& before, const Pose& now, const Needle& needle, TipContact& tip, std::span<ShaftContact> shaft);
  /// The rest goes on, once the cut is aimed: the cut, the needle's shape, the forces.
  void go_on(Needle& needle, TipContact& tip, std::span<ShaftContact> shaft);
  /// All goes back to where the sub-step began.
  void go_back(Needle& needle, TipContact& tip, std::span<ShaftContact> shaft) const;
  /// A sub-step is over.
  /// @param cut [mm] way of the tip in it @param steady whether it was balanced soon, the tip having kept its state
  void end(double cut, bool steady, const Needle& needle, TipContact& tip, std::span<ShaftContact> shaft);

  /// There was no contact in the sub-step: the next one has no pace.
  void interrupt() { steady_ = false; }
  /// The base is put elsewhere: nothing is known.
  void forget();

  /// Whether forces and shape of the sub-step are expected to change.
  [[nodiscard]] bool expects_forces() const { return force_.share != 0.0; }
  /// [mm] Way of the base along its axis in the last sub-step.
  [[nodiscard]] double last_way() const { return last_way_; }
  /// [mm] How far the base has moved in the last sub-step: its origin, and by its turn a point as far from it as the
  /// needle is long.
  [[nodiscard]] double last_motion() const { return last_motion_.norm(); }
  /// [mm] LPS, the needle's tip at the start of the sub-step, with the base of its end.
  [[nodiscard]] const Vec3& tip_start() const { return tip_start_; }

 private:
  Eigen::Vector<double, 6> last_motion_ = Eigen::Vector<double, 6>::Zero();
  double last_way_ = 0.0;
  double last_cut_ = 0.0;  ///< [mm] way of the tip through tissue in the last sub-step
  double cut_more_ = 0.0;  ///< [mm] the part of it that was not in proportion to the way before
  Vec3 tip_start_ = Vec3::Zero();
  VecX shape_start_;   ///< Needle::state() at the start of the sub-step
  VecX shape_gained_;  ///< its change in the last sub-step
  VecX shape_more_;    ///< the part of that change that was not in proportion to the change before
  VecX expected_;      ///< room for a state
  Pace force_;         ///< of forces and the needle's shape
  Pace way_;           ///< of slides and the cut
  bool steady_ = false;
};

}  // namespace stylet
