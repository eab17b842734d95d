// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"
#include "coupling/balance/resting_matrix.hpp"

namespace stylet {

/// E: how much further than a linear law from the last look says the tip moves the contacts at rest, because it is at
/// another place, and because tissue under it stiffens (RestingHold). Most of E is like that directly before the last
/// look, the usual one, whose answer B⁻¹ E is known. Nothing allocates after construction.
class TipDrift {
 public:
  /// @param rows largest number of rows of the contacts at rest and of springs
  explicit TipDrift(Eigen::Index rows);

  /// Nothing is known of E and of its change along the cut.
  void forget();
  /// Before a look: the present E becomes the usual one. @return it [mm] (rows)
  [[nodiscard]] Eigen::Ref<const VecX> remember(const Contacts& all, const RestingMatrix& matrix);
  /// At a look: E begins at zero.
  void look(const Contacts& all, const RestingMatrix& matrix);

  /// Begins a sub-step after the last look. @return how many times more than before the usual E is in the present one
  [[nodiscard]] double begin(const Contacts& all, const RestingMatrix& matrix);
  /// After a balance: whether E is now what it was taken for; if not, its change along the cut is corrected.
  [[nodiscard]] bool fits(const Contacts& all, const RestingMatrix& matrix);

  /// [mm] (rows × 2) E at the start of the sub-step less its usual part, and its change per mm of cut.
  [[nodiscard]] auto at_rest(const RestingMatrix& matrix) const { return at_rest_.topRows(matrix.rows()); }

 private:
  void write(const Contacts& all, const RestingMatrix& matrix, Eigen::Ref<VecX> E) const;

  Vec3 tip_force_ = Vec3::Zero();  ///< [N] at the last look
  VecX moves_;                     ///< [mm] (rows) by that force
  MatX columns_;                   ///< [mm/N] (rows × 3) derivative of moves_
  VecX usual_;                     ///< [mm] (rows)
  double as_usual_ = 0.0;          ///< how many times usual_ is in E
  MatX at_rest_;
  VecX now_;  ///< work space
};

}  // namespace stylet
