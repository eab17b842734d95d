// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/laws.hpp"

namespace stylet {

/// How tissue creeps under the forces it has borne: a standard linear solid with one time constant τ for all tissue.
/// On top of its elastic displacement A f come the displacements F p, with F the wide part of the compliance
/// (ContactCompliance::wide()) and p the lasting forces,
///   p = (r − 1) m,   m + τ ṁ = f,
/// r the creep factor and f the forces of the contacts, for every material point and for those the needle has left.
/// Backward Euler over a sub-step of h:
///   p = share f + past,   share = (r − 1) h / (h + τ),   past = (r − 1) τ / (h + τ) m_before.
/// docs/theory/tissue.md derives it. Nothing allocates after construction.
class TissueMemory {
 public:
  /// @param points most points of the compliance, tip included
  TissueMemory(const Creep& creep, int points);

  [[nodiscard]] bool on() const { return creep_.is_any(); }

  /// A sub-step of h seconds begins.
  void begin(double h);

  /// r − 1: how much of a force becomes lasting in the end.
  [[nodiscard]] double most() const { return creep_.factor - 1.0; }

  /// How much of a sub-step's force has become lasting at its end; 0 between sub-steps, and for elastic tissue.
  [[nodiscard]] double share() const { return most() * (1.0 - kept_); }

  /// What is left of the lasting force on a point [N] when this sub-step's force is not counted.
  [[nodiscard]] Vec3 past(int point) const { return most() * kept_ * remembered_.col(point); }

  /// Adds up what is remembered of the shaft's points, after which displacement() is quick: while the tip goes on in a
  /// sub-step, no other sum changes.
  void gather(const ContactCompliance& compliance);
  /// Displacement of a point by past() on all points [mm].
  [[nodiscard]] Vec3 displacement(const ContactCompliance& compliance, int point) const;

  /// The sub-step is over: its forces are past as well.
  /// @param forces [N] (3 × points) on the tissue
  void end(const Eigen::Ref<const MatX>& forces);

  /// Moves a part of what is remembered from one point to another.
  void hand_over(int from, int to, double part);

  /// Forgets what is remembered of a point: it is another material point from now on.
  void forget(int point) {
    remembered_.col(point).setZero();
    gathered_ = false;
  }

  /// True when earlier forces displace no point by more than a nanometre.
  [[nodiscard]] bool relaxed(const ContactCompliance& compliance) const;

  void reset();

 private:
  Creep creep_;
  double kept_ = 1.0;  ///< part of what is remembered that is left at the end of the sub-step
  MatX remembered_;    ///< m [N] (3 × points)
  MatX of_shaft_;      ///< F m [mm] (3 × points) without the tip's m, where gathered_
  bool gathered_ = false;
  unsigned version_ = 0;  ///< of the compliance when it was gathered
};

}  // namespace stylet
