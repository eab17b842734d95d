// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/laws.hpp"

#include <span>

namespace stylet {

/// The memory of creeping tissue: a standard linear solid with one time constant τ for all tissue. In addition to the
/// elastic displacement A f the tissue has the displacement F p, with the wide part F of the compliance
/// (ContactCompliance::wide()) and the lasting forces p,
///   p = (r − 1) m,   m + τ ṁ = f,
/// with the creep factor r and the contacts' forces f, at every point, including points that the needle has left.
/// Backward Euler over a sub-step of h gives
///   p = share f + past,   share = (r − 1) h / (h + τ),   past = (r − 1) τ / (h + τ) m_before.
/// docs/theory/tissue.md derives it. Nothing allocates after construction.
class TissueMemory {
 public:
  /// @param points largest number of points of the compliance, tip included
  TissueMemory(const Creep& creep, int points);

  [[nodiscard]] bool on() const { return creep_.is_any(); }

  /// Begins a sub-step of h seconds.
  void begin(double h);

  /// r − 1: the part of a constant force that has become lasting in the end.
  [[nodiscard]] double most() const { return creep_.factor - 1.0; }

  /// The part of this sub-step's force that is lasting at its end; 0 between sub-steps, and for elastic tissue.
  [[nodiscard]] double share() const { return most() * (1.0 - kept_); }

  /// The part of the memory that is left after this sub-step.
  [[nodiscard]] double kept() const { return kept_; }
  /// m [N] of a point.
  [[nodiscard]] auto remembered(int point) const { return remembered_.col(point); }

  /// Lasting force on a point [N] by earlier sub-steps only.
  [[nodiscard]] Vec3 past(int point) const { return most() * kept_ * remembered_.col(point); }

  /// Sums the displacements by the shaft points' memory, which makes displacement() fast: while the cut advances in a
  /// sub-step, only the tip's terms change.
  void gather(const ContactCompliance& compliance);
  /// The same for some shaft points only, by the memory of the points `by` alone and that of the tip; displacement()
  /// must not be asked for other shaft points until release().
  void gather(const ContactCompliance& compliance, std::span<const int> points, std::span<const int> by);
  void release() { gathered_ = Gathered::none; }
  /// Displacement of a point by past() on all points [mm].
  [[nodiscard]] Vec3 displacement(const ContactCompliance& compliance, int point) const;

  /// Ends the sub-step: its forces enter the memory.
  /// @param forces [N] (3 × points) on the tissue
  void end(const Eigen::Ref<const MatX>& forces);

  /// In this sub-step: the forces on a point in earlier ones were larger than those in end(), together by `force` [N].
  void make_up(int point, const Vec3& force) {
    remembered_.col(point) += (1.0 - kept_) * force;
    gathered_ = Gathered::none;
  }

  /// Moves a part of the memory of one point to another.
  void hand_over(int from, int to, double part);

  /// Clears the memory of a point, which becomes another material point.
  void forget(int point) {
    remembered_.col(point).setZero();
    gathered_ = Gathered::none;
  }

  /// Whether earlier forces displace no point by more than a nanometre.
  [[nodiscard]] bool relaxed(const ContactCompliance& compliance) const;

  void reset();

 private:
  Creep creep_;
  double kept_ = 1.0;  ///< the part of m that is left at the end of the sub-step
  MatX remembered_;    ///< m [N] (3 × points)
  MatX of_shaft_;      ///< F m [mm] (3 × points) without the tip's m
  enum class Gathered { none, some, all };
  Gathered gathered_ = Gathered::none;  ///< the columns of of_shaft_ that are valid
  std::span<const int> by_;             ///< shaft points whose memory counts, where only some columns are valid
  unsigned version_ = 0;                ///< version of the compliance when of_shaft_ was computed
};

}  // namespace stylet
