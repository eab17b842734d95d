// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <vector>

namespace stylet {

/// The rows of GripMatrix whose entries change between iterations, and the springs' rows, factorised. When all other
/// rows have been eliminated, these leave
///   M = R + Tᵀ diag(d) T,   T = [F, I],
/// with the springs' s rows first and then c rows of contacts. R does not change. d [mm/N] is what each contact's row
/// gives way by itself, and F (c × s) holds the springs' directions in terms of the contacts' rows.
///
/// The contacts' block is positive definite and has a Cholesky factor, of which only the columns from the first one
/// with a new d are computed again. The springs are eliminated last, by LU with pivoting, because what is left of their
/// block is not definite. Nothing allocates after construction.
class YieldingRows {
 public:
  /// @param most_rows largest number c of contacts' rows @param most_spring_rows largest s, even
  /// @param most_columns largest number of right-hand sides of one solve()
  YieldingRows(Eigen::Index most_rows, Eigen::Index most_spring_rows, Eigen::Index most_columns);

  /// Begins a new matrix without contacts' rows and with F = 0. @param spring_rows s
  void begin(Eigen::Index spring_rows);
  /// Adds a contact's row after those there. @param yield its d [mm/N]
  void add_row(double yield);
  /// Sets the two components of F for a contact's row and a spring. No row has components of two springs.
  /// @param spring_row first of the spring's two rows
  void add_direction(Eigen::Index row, Eigen::Index spring_row, const Eigen::RowVector2d& components);
  /// Forgets all contacts' rows but the first; the others must not be in F.
  void keep_first(Eigen::Index rows);

  [[nodiscard]] Eigen::Index rows() const { return static_cast<Eigen::Index>(yield_.size()); }
  [[nodiscard]] Eigen::Index spring_rows() const { return spring_rows_; }

  /// Changes d of a contact's row [mm/N].
  void set_yield(Eigen::Index row, double yield);

  /// Whether there is a factor of M as it is now.
  [[nodiscard]] bool factorised() const { return factorised_; }
  /// Factorises M. @param R [mm/N] ((s + c) × (s + c)) its lower triangle is read; as long as begin() has not been
  /// called since the last call, its rows that were there then must be the same
  /// @return false where M is found singular, or its contacts' block not positive definite
  [[nodiscard]] bool factorise(const Eigen::Ref<const MatX>& R);
  /// Y ← M⁻¹ Y. Only after factorise(). @param Y ((s + c) × k) the springs' rows first
  void solve(Eigen::Ref<MatX> Y);

 private:
  struct Direction {
    Eigen::Index row = 0;
    Eigen::Index spring_row = 0;
    Eigen::RowVector2d components = Eigen::RowVector2d::Zero();
  };

  [[nodiscard]] bool factorise_contacts(const Eigen::Ref<const MatX>& R);
  [[nodiscard]] bool factorise_springs(const Eigen::Ref<const MatX>& R);

  std::vector<double> yield_;          ///< (c) d
  Eigen::Index spring_rows_ = 0;       ///< s
  std::vector<Direction> directions_;  ///< entries of F that are not zero, two by two
  bool factorised_ = false;
  Eigen::Index unchanged_columns_ = 0;  ///< so many first columns of contacts_ are still those of the factor
  MatX contacts_;                       ///< (c × c) L of the contacts' block
  MatX by_springs_;                     ///< (c × s) L⁻¹ of the springs' columns of the contacts' rows
  MatX springs_;                        ///< (s × s) what elimination of the contacts leaves of the springs' block: LU
  std::vector<int> pivots_;             ///< (s)
  MatX work_;                           ///< (s × most columns)
};

}  // namespace stylet
