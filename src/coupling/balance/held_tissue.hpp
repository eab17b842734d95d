// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/dense_kernels.hpp"
#include "coupling/balance/sliding_rows.hpp"

#include <algorithm>

namespace stylet {

/// The part of the tissue's compliance among the contacts of the moved needle (the "others") that the needles at rest
/// take away: A_or S B⁻¹ Sᵀ A_ro, where S = (I, E) adds the springs' forces to the pushes (RestingGrips). Three columns
/// for each contact, the tip first. Nothing allocates after construction.
class HeldTissue {
 public:
  /// @param most_others largest number of contacts of the moved needle, its tip included
  HeldTissue(int grips, int most_others);

  /// Number of contacts of the moved needle, its tip included, whose columns are there.
  [[nodiscard]] int known() const { return known_; }
  [[nodiscard]] Eigen::Index others() const { return 3 * static_cast<Eigen::Index>(known_); }
  /// Removes all contacts but the tip, whose columns become zero: B is new.
  void clear();
  void keep_first(int contacts) { known_ = std::min(known_, contacts); }

  /// Adds a shaft contact after those that are there.
  /// @param A [mm/N] (3 grips × 3) displacements of the contacts at rest by forces there
  void add(const Eigen::Ref<const MatX>& A, RestingMatrix& matrix, const SlidingRows& sliding);
  /// The same in two steps. @return the columns of A, to be written
  auto next(const RestingMatrix& matrix) { return A_.block(0, others(), matrix.contact_rows(), 3); }
  void add_next(RestingMatrix& matrix, const SlidingRows& sliding);
  /// Writes the columns Sᵀ A_rt of a tip at a new place; B⁻¹ of them has to follow in set_tip().
  /// @param A [mm/N] (3 grips × 3)
  auto begin_tip(const Eigen::Ref<const MatX>& A, const RestingMatrix& matrix) {
    extend(A, 0, matrix);
    return A_.topLeftCorner(matrix.rows(), 3);
  }
  void set_tip(const Eigen::Ref<const MatX>& solved, const RestingMatrix& matrix, const SlidingRows& sliding);
  /// Follows a change of the contacts that slide.
  void follow(const RestingMatrix& matrix, const SlidingRows& sliding);

  /// [mm/N] (3 known × 3 known)
  [[nodiscard]] auto reduction() const { return reduction_.topLeftCorner(others(), others()); }
  /// Motion of the others by a solved column, after the sliding contacts have yielded. @param motion (3 known) written
  void motion(const Eigen::Ref<const VecX>& z, const RestingMatrix& matrix, SlidingRows& sliding,
              Eigen::Ref<VecX> motion) const;
  /// A_or λ. @param forces [N] λ, on the tissue at the contacts at rest (3 grips) @param motion (3 known) written
  void displacement(const Eigen::Ref<const VecX>& forces, Eigen::Ref<VecX> motion) const;
  // NOLINTBEGIN(performance-unnecessary-value-param): the results are written through their views
  /// Wᵀ Y with the solved columns W = B⁻¹ Sᵀ A_ro, sliding contacts held. @param Y [mm] (rows × k) @param motion
  /// (3 known × k) written
  void answers(const Eigen::Ref<const MatX>& Y, Eigen::Ref<MatX> motion) const {
    dense::transposed_product(motion, solved_.topLeftCorner(Y.rows(), others()), Y);
  }
  /// Adds Wᵀ Y for Y whose rows are zero but for those from `from` on. @param work (3 known × k) work space
  void add_answers(Eigen::Index from, const Eigen::Ref<const MatX>& Y, Eigen::Ref<MatX> motion,
                   Eigen::Ref<MatX> work) const {
    dense::transposed_product(work, solved_.block(from, 0, Y.rows(), others()), Y);
    motion += work;
  }
  // NOLINTEND(performance-unnecessary-value-param)
  /// W of the rows from `from` on. @param count their number
  [[nodiscard]] auto solved(Eigen::Index from, Eigen::Index count) const {
    return solved_.block(from, 0, count, others());
  }
  /// Eᵀ W, with E of SlidingRows, and the same after SlidingRows::divide(). @param count of the sliding contacts
  [[nodiscard]] auto of_sliding(Eigen::Index count) const { return of_sliding_.topLeftCorner(count, others()); }
  [[nodiscard]] auto slipped(Eigen::Index count) const { return slipped_.topLeftCorner(count, others()); }

  /// z −= B⁻¹ Sᵀ A_ro Δ. @param forces [N] (3 known) Δ
  void subtract(const Eigen::Ref<const VecX>& forces, Eigen::Ref<VecX> z) const;

 private:
  void extend(const Eigen::Ref<const MatX>& A, Eigen::Index at, const RestingMatrix& matrix);
  void reduce(Eigen::Index first, const RestingMatrix& matrix, const SlidingRows& sliding);
  void slide(Eigen::Index first, Eigen::Index count, const RestingMatrix& matrix, const SlidingRows& sliding);

  int known_ = 1;
  MatX A_;           ///< (rows × 3 others) Sᵀ A_ro
  MatX solved_;      ///< (rows × 3 others) B⁻¹ Sᵀ A_ro
  MatX of_sliding_;  ///< (sliding × 3 others) Eᵀ B⁻¹ Sᵀ A_ro, with E of SlidingRows
  MatX slipped_;     ///< (sliding × 3 others) the same after SlidingRows::divide()
  MatX whole_;       ///< (3 others × 3 others) the reduction without sliding
  MatX reduction_;   ///< (3 others × 3 others) with it
};

}  // namespace stylet
