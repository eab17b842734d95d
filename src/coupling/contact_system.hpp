// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <vector>

namespace stylet {

/// The linear equations of one Newton iteration, in the contacts' local frames (three rows a contact: two lateral, one
/// axial). Tissue: u = A λ. Needle, under p: r = r_now + free − N (p − f_now). Held rows:
///   (A λ)_i + D_i λ_i = (r − X)_i + shift_i,      other rows: λ_i = 0.
/// Without springs λ = p and the matrix A + N + D is symmetric positive definite. Where the needle alone would buckle,
/// N is that of the needle on springs G (Needle::linearise) whose forces belong to the contacts: λ = p + G (r − r_now),
/// matrix (A + D)(I − G N) + N, unsymmetric and regular as long as needle and tissue together are stable. Sized once;
/// nothing allocates after that.
class ContactSystem {
 public:
  explicit ContactSystem(int contacts);

  MatX A;                  ///< [mm/N] lower triangle (block rows c ≥ d are written)
  MatX N;                  ///< [mm/N] full
  VecX gap;                ///< [mm] (r_now + free − X) in local frames
  VecX free;               ///< [mm] in local frames
  VecX now;                ///< [N] f_now in local frames
  VecX spring;             ///< [N/mm] G, zero without springs
  VecX D;                  ///< [mm/N] what each row yields by itself
  VecX shift;              ///< [mm]
  std::vector<int> rows;   ///< held rows
  bool supported = false;  ///< springs are lent

  VecX lambda;  ///< [N] contact forces on the tissue
  VecX p;       ///< [N] what the needle is to be advanced with (its loads are −p)

  /// Call after A, N, gap, free, now are written for `size` rows.
  void begin(Eigen::Index size);

  /// The needle's side of a row moves by `way` [mm]: its contact went back along the shaft.
  void move_row(int row, double way) { needle_[row] += way; }

  /// λ and p for the present rows, D and shift. False when the matrix is singular.
  bool solve();

  /// (r − X − A λ)_i of the last solution: how far the needle is beyond the tissue in a row that is not held [mm].
  [[nodiscard]] double opening(int row) const;

  /// Diagonal of A + N + D: how far a row gives way to its own unit force [mm/N].
  [[nodiscard]] double yield(int row) const { return A(row, row) + N(row, row) + D[row]; }

 private:
  [[nodiscard]] double a(Eigen::Index i, Eigen::Index j) const { return i >= j ? A(i, j) : A(j, i); }
  bool solve_symmetric(Eigen::Index held);
  bool solve_supported(Eigen::Index held);

  Eigen::Index size_ = 0;
  VecX needle_;   ///< gap + N now
  VecX preload_;  ///< G (free + N now)
  MatX matrix_;
  MatX work_;
  VecX right_;
};

}  // namespace stylet
