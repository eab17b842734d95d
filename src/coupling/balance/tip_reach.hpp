// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"
#include "coupling/balance/resting_grips.hpp"
#include "coupling/balance/tip_law.hpp"

namespace stylet {

/// A place of the tip.
struct TipPlace {
  Vec3 x = Vec3::Zero();  ///< [mm] LPS
  double cut = 0.0;       ///< [mm] length of cut since the last look
};

/// First columns in TipReach of V now (extrapolated to s = 0), of its change with s, of V at the last look, and of the
/// usual E; and the number of all columns.
struct TipColumns {
  static constexpr Eigen::Index kNow = 0, kSlope = 6, kLook = 12, kUsual = 18, kCount = 19;
};

/// How the tip of the moved needle moves the contacts at rest, and what the moved needle feels of that while they
/// follow (RestingHold). With the force λ on the tip and the part ρ of it that stiffening spares the tissue
/// (TipRelief), the tip moves the contacts at rest by
///   V v,   V = (A_rt, C_r),   v = (λ, −ρ),
/// where C_r is the part of A_rt that has the needle's own scale. (Where tissue creeps, A_rt includes the creep of a
/// sub-step, and the wide part F_rt follows from both.) V changes as the tip cuts on. It is known at the last look at
/// all contacts at rest, V_l; from there each contact's rows go on linearly in the length s of cut, as its last two
/// visits say. Of E, how much further the tip moves the contacts at rest than the linear law of the last look says,
///   E = V(s) v − V_l w,   w = v_l + v′_l (λ − λ_l),
/// the moved needle feels A_or B⁻¹ E = Wᵀ E with the solved columns W = B⁻¹ A_ro (HeldTissue), which takes only the
/// images Wᵀ V. Most of E is like that directly before the last look, the usual one, whose answer at rest, B⁻¹ E, is
/// known. Nothing allocates after construction.
class TipReach : private TipColumns {
 public:
  /// @param most_own largest number of contacts of the moved needle, its tip included
  TipReach(int grips, int most_own);

  /// Nothing is known of E.
  void forget() { columns_.col(kUsual).setZero(); }
  /// Before a look: the present E becomes the usual one. @return it [mm] (rows)
  [[nodiscard]] Eigen::Ref<const VecX> remember(const Contacts& all, const RestingMatrix& matrix);
  /// At a look: E begins at zero.
  void look(const Contacts& all, const RestingMatrix& matrix);
  /// Makes the images anew for the contacts at rest that slide.
  /// @param columns whether W or V is new, too
  /// @param forces [N] (3 grips) on the contacts at rest, from which changes are counted from now on
  void take(bool columns, const Contacts& all, RestingGrips& grips, const Eigen::Ref<const VecX>& forces);
  /// The force on a contact at rest changes by `force`, and its memory by `memory` [N].
  void change(int grip, const Vec3& force, const Vec3& memory);

  /// Begins a sub-step. @return how much more often than in the forces of take() the usual E is in the present one
  [[nodiscard]] double begin(const Contacts& all, RestingGrips& grips);
  /// Looks at contacts at rest, with the tip at its present place. @param first, end numbers from 0 on
  void visit(const Contacts& all, int first, int end, RestingGrips& grips, const Eigen::Ref<const VecX>& forces);
  /// Ends a sub-step with the tip at its present place. @param kept TissueMemory::kept()
  void end(const Contacts& all, double kept);

  /// [mm] Length of cut since the last look, at the present place of the tip.
  [[nodiscard]] double cut(const Contacts& all) const { return at_.cut + (all.tip.cut.x() - at_.x).norm(); }
  /// Whether the tip is where the last sub-step left it.
  [[nodiscard]] bool is_at(const Vec3& x) const { return (x - at_.x).squaredNorm() < 1e-18; }

  /// [mm] Wᵀ E less the usual part in the forces of take(), for a contact of the moved needle.
  [[nodiscard]] Vec3 felt(const Contacts& all, Eigen::Index row) const;
  /// [mm] Displacement of the tip by the forces of take(), and by their change under forces on the moved needle because
  /// the tip has moved since the last look. @param own, own_before [N] (3 own) the latter, now and in take()
  [[nodiscard]] Vec3 at_tip(const Contacts& all, const Eigen::Ref<const VecX>& own,
                            const Eigen::Ref<const VecX>& own_before) const;
  /// [mm] F_tr m: displacement of the tip by the memory m of the contacts at rest.
  [[nodiscard]] Vec3 remembered(const Contacts& all) const;
  /// [mm] Σ_c C_cᵀ g_c over the forces of take().
  [[nodiscard]] Vec3 of_others(const Contacts& all) const;

 private:
  using Vec6 = TipLaw::Vec6;
  using Weights = Eigen::Matrix<double, kCount, 1>;

  [[nodiscard]] Weights weights(const Contacts& all) const;
  void write(const Contacts& all, int grip, Eigen::Ref<MatX> V) const;

  MatX columns_;                         ///< [mm/N] (rows × kCount)
  std::vector<double> seen_;             ///< [mm] (grips) length of cut at the last visit
  TipLaw look_, start_;                  ///< at the last look, and at the start of the sub-step
  TipPlace at_;                          ///< at the start of the sub-step
  double taken_ = 0.0, as_usual_ = 0.0;  ///< how often the usual E is in the forces of take(), and in the present E
  MatX of_own_, of_sliding_;             ///< (3 own, or sliding, × kCount) images Wᵀ V, and Zᵀ V of SlidingRows
  Weights of_forces_ = Weights::Zero();  ///< the same for the forces of take()
  /// The same for the memory at rest, and for the present forces.
  Eigen::Matrix<double, kLook, 2> of_memory_ = Eigen::Matrix<double, kLook, 2>::Zero();
  MatX held_;           ///< (3 own × kCount) of_own_ after the sliding contacts have yielded
  MatX change_, work_;  ///< work space
};

}  // namespace stylet
