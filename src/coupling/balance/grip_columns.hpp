// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/needle_side.hpp"

namespace stylet {

/// Columns beside the matrix B of the shaft's contacts (GripMatrix), and B⁻¹ of them: a force of the spring at the tip,
/// a push at the tip, the right-hand side, and the drift. Half of the work on the columns of the tip does not depend on
/// what the contacts yield and is kept. Nothing allocates after construction.
class GripColumns {
 public:
  /// @param most contacts, tip included
  explicit GripColumns(int most);

  /// The columns of the tip are of an earlier matrix, tip or needle.
  void outdate() { current_ = false; }
  [[nodiscard]] bool is_current() const { return current_; }
  /// Takes the columns of the tip.
  /// @param A [mm/N] tissue's compliance, full
  void take_tip(const MatX& A, const NeedleSide& needle, GripMatrix& grips);
  /// Solves for the columns of the tip where B has changed since, and for the others.
  /// @param drifts whether there is a drift
  void solve(const NeedleSide& needle, GripMatrix& grips, bool drifts);

  /// (rows of B × 3) a push at the tip; the transpose is the tip's rows.
  [[nodiscard]] auto push(Eigen::Index rows) const { return column_.block(0, kTip, rows, 3); }
  /// (rows of B × 3) B⁻¹ of a push at the tip.
  [[nodiscard]] auto solved_push(Eigen::Index rows) const { return solved_.block(0, kTip, rows, 3); }
  /// (rows of B × 3) B⁻¹ of a force of the spring at the tip.
  [[nodiscard]] auto solved_spring(Eigen::Index rows) const { return solved_.block(0, kSpring, rows, 3); }
  /// (rows of B) the right-hand side, and after solve() B⁻¹ of it.
  [[nodiscard]] auto right(Eigen::Index rows) { return solved_.col(kRight).head(rows); }
  [[nodiscard]] auto right(Eigen::Index rows) const { return solved_.col(kRight).head(rows); }
  /// (rows of B) the drift, and after solve() B⁻¹ of it.
  [[nodiscard]] auto drift(Eigen::Index rows) { return solved_.col(kDrift).head(rows); }
  [[nodiscard]] auto drift(Eigen::Index rows) const { return solved_.col(kDrift).head(rows); }

 private:
  // Where each is among the columns; those that are solved at the same time are neighbours.
  static constexpr Eigen::Index kSpring = 0;
  static constexpr Eigen::Index kTip = 3;
  static constexpr Eigen::Index kRight = 6;
  static constexpr Eigen::Index kDrift = 7;

  MatX column_;                   ///< (rows × 6) columns of the tip
  MatX begun_;                    ///< (rows × 6) the same, half solved
  MatX solved_;                   ///< (rows × 8) B⁻¹ of all
  bool current_ = false;          ///< column_ and begun_ are of the present matrix and tip
  std::uint64_t solved_for_ = 0;  ///< version of the matrix that the tip's columns of solved_ are of
};

}  // namespace stylet
