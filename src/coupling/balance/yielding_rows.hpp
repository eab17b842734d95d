// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <vector>

namespace stylet {

/// The yielding rows of GripMatrix, whose entries change between iterations, and the springs' rows, with their
/// factorisation. When the settled rows have been eliminated, these rows leave
///   M = R + Tᵀ diag(d) T,   T = [F, I],
/// with the springs' s rows first and then c rows of contacts. R does not change. d [mm/N] is the own yield of each
/// contact's row, and F (c × s) holds the springs' directions in terms of the contacts' rows.
///
/// The contacts' block is positive definite and has a Cholesky factor, whose columns are recomputed only from the first
/// one with a new d on. The springs are eliminated last, by LU with pivoting, because their Schur complement is not
/// definite. Nothing allocates after construction.
class YieldingRows {
 public:
  /// @param most_rows largest number c of contacts' rows @param most_spring_rows largest s, even
  /// @param most_columns largest number of right-hand sides of one solve()
  YieldingRows(Eigen::Index most_rows, Eigen::Index most_spring_rows, Eigen::Index most_columns);

  /// Begins a new matrix without contacts' rows and with F = 0. @param spring_rows s
  void begin(Eigen::Index spring_rows);
  /// Adds a contact's row after the present ones. @param yield its d [mm/N]
  void add_row(double yield);
  /// Sets the two components of F for a contact's row and a spring. A row has components of one spring only.
  /// @param spring_row first of the spring's two rows
  void add_direction(Eigen::Index row, Eigen::Index spring_row, const Eigen::RowVector2d& components);
  /// Removes all contacts' rows but the first `rows`; the removed ones must not be in F.
  void keep_first(Eigen::Index rows);

  [[nodiscard]] Eigen::Index rows() const { return static_cast<Eigen::Index>(yield_.size()); }
  [[nodiscard]] Eigen::Index spring_rows() const { return spring_rows_; }

  /// Changes d of a contact's row [mm/N].
  void set_yield(Eigen::Index row, double yield);

  /// Whether the factor belongs to the present M.
  [[nodiscard]] bool factorised() const { return factorised_; }
  /// Factorises M.
  /// @param R [mm/N] ((s + c) × (s + c)), lower triangle; rows that were there in the last call must be unchanged
  /// since, unless begin() was called
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
  std::vector<Direction> directions_;  ///< nonzero entries of F, two for each row
  bool factorised_ = false;
  Eigen::Index unchanged_columns_ = 0;  ///< number of leading columns of contacts_ that are still valid
  MatX contacts_;                       ///< (c × c) L of the contacts' block
  MatX by_springs_;                     ///< (c × s) L⁻¹ times the springs' columns in the contacts' rows
  MatX springs_;                        ///< (s × s) LU factors of the springs' Schur complement
  std::vector<int> pivots_;             ///< (s)
  MatX work_;                           ///< (s × most columns)
};

}  // namespace stylet
