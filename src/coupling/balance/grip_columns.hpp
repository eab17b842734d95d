// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/needle_side.hpp"

namespace stylet {

/// Columns beside the matrix B of the shaft contacts (GripMatrix), and B⁻¹ times them: force of the spring at the tip,
/// push at the tip, right-hand side, and drift. The half of the work on the tip's columns that does not depend on D is
/// kept. Nothing allocates after construction.
class GripColumns {
 public:
  /// @param most largest number of contacts, tip included
  explicit GripColumns(int most);

  /// Marks the tip's columns as outdated, because the matrix, the tip or the needle has changed.
  void outdate() { current_ = false; }
  [[nodiscard]] bool is_current() const { return current_; }
  /// Assembles the tip's columns.
  /// @param A [mm/N] compliance of the tissue among the contacts of the matrix, their tip first
  /// @param first row of the first of these contacts, without the tip, on the needle's side
  void take_tip(const MatX& A, const NeedleSide& needle, Eigen::Index first, GripMatrix& grips);
  /// Solves for the tip's columns if B has changed since the last call, and for the other columns.
  /// @param drifts whether the drift is used
  void solve(const NeedleSide& needle, GripMatrix& grips, bool drifts);

  /// (rows of B × 3) columns of a push at the tip; their transpose gives the tip's rows.
  [[nodiscard]] auto push(Eigen::Index rows) const { return column_.block(0, kTip, rows, 3); }
  /// (rows of B × 3) B⁻¹ times the columns of a push at the tip.
  [[nodiscard]] auto solved_push(Eigen::Index rows) const { return solved_.block(0, kTip, rows, 3); }
  /// (rows of B × 3) B⁻¹ times the columns of a force of the spring at the tip.
  [[nodiscard]] auto solved_spring(Eigen::Index rows) const { return solved_.block(0, kSpring, rows, 3); }
  /// (rows of B) right-hand side; after solve(), B⁻¹ times it.
  [[nodiscard]] auto right(Eigen::Index rows) { return solved_.col(kRight).head(rows); }
  [[nodiscard]] auto right(Eigen::Index rows) const { return solved_.col(kRight).head(rows); }
  /// (rows of B) drift; after solve(), B⁻¹ times it.
  [[nodiscard]] auto drift(Eigen::Index rows) { return solved_.col(kDrift).head(rows); }
  [[nodiscard]] auto drift(Eigen::Index rows) const { return solved_.col(kDrift).head(rows); }

 private:
  // First column of each group; groups that are solved together are adjacent.
  static constexpr Eigen::Index kSpring = 0;
  static constexpr Eigen::Index kTip = 3;
  static constexpr Eigen::Index kRight = 6;
  static constexpr Eigen::Index kDrift = 7;

  MatX column_;                   ///< (rows × 6) the tip's columns
  MatX begun_;                    ///< (rows × 6) the tip's columns after GripMatrix::begin()
  MatX solved_;                   ///< (rows × 8) B⁻¹ times all columns
  bool current_ = false;          ///< column_ and begun_ belong to the present matrix and tip
  std::uint64_t solved_for_ = 0;  ///< version of the matrix with which the tip's columns of solved_ were solved
};

}  // namespace stylet
