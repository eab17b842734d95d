// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"

namespace stylet {

/// What a viscous tissue still feels of earlier forces. A Kelvin–Voigt solid with one relaxation time τ for all tissue,
/// K (u + τ u̇) = f, keeps the elastic compliance when the forces are filtered: u = A g with g + τ ġ = f, for every
/// material point and for those the needle has left. Backward Euler over a sub-step of h:
///   g = share f + past,   share = 1 / (1 + τ/h),   past = (1 − share) g_before.
/// Elastic (share 1, nothing past) with τ = 0. Nothing allocates after construction.
class TissueMemory {
 public:
  /// @param relaxation_s τ [s], ≥ 0
  /// @param points most points of the compliance, tip included
  TissueMemory(double relaxation_s, int points);

  [[nodiscard]] bool on() const { return relaxation_s_ > 0.0; }

  /// A sub-step of h seconds begins.
  void begin(double h);

  /// Weight of this sub-step's forces; 0 between sub-steps, when all is past.
  [[nodiscard]] double share() const { return share_; }

  /// Filtered earlier forces on a point [N].
  [[nodiscard]] auto past(int point) const { return past_.col(point); }

  /// Displacement of a point by earlier forces [mm].
  [[nodiscard]] Vec3 displacement(const ContactCompliance& compliance, int point) const;

  /// The sub-step is over: its forces are past as well.
  /// @param forces [N] (3 × points) on the tissue
  void end(const Eigen::Ref<const MatX>& forces);

  /// Moves a part of what is past from one point to another.
  void hand_over(int from, int to, double part);

  /// The point's compliance has changed, but it is the same material: changes what is past there so that earlier forces
  /// displace it by `u` [mm] as before.
  void keep_displacement(const ContactCompliance& compliance, int point, const Vec3& u);

  /// Forgets a point's past: it is another material point from now on.
  void forget(int point) { past_.col(point).setZero(); }

  /// True when earlier forces displace no point by more than a nanometre.
  [[nodiscard]] bool relaxed(const ContactCompliance& compliance) const;

  void reset();

 private:
  double relaxation_s_;
  double share_ = 1.0;
  MatX past_;  ///< [N] (3 × points)
};

}  // namespace stylet
