// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/grip_rows.hpp"
#include "coupling/balance/lent_springs.hpp"
#include "coupling/balance/yield.hpp"
#include "coupling/balance/yielding_rows.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace stylet {

/// Matrix of the equations of the shaft's contacts, all held in all directions (ContactSystem has the derivation):
///   B = [P + N,  P E;  Eᵀ P,  Eᵀ P E − K⁻¹],  P = A + diag(D),
/// where A and N are the tissue's and the needle's compliance, E holds the two directions of each lent spring, and K
/// their stiffness. P + N is symmetric positive definite.
///
/// The matrix is factorised once and used over many steps. Only D changes meanwhile, because contacts come to slide or
/// to hold and the tissue around new contacts hardens. Therefore rows that have no D and will have none are eliminated
/// first and stay so (GripRows). What they leave of the other rows, two fifths of all, is a small matrix, which is
/// factorised again whenever D changes, no matter for how many contacts (YieldingRows).
///
/// Columns have three rows per contact in LPS, 3g in all, and then two per spring. Nothing allocates after
/// construction.
class GripMatrix {
 public:
  explicit GripMatrix(int grips);

  /// @param A, N [mm/N] (3g × 3g) @param springs (g), or none @param yields (g)
  /// @return false where the matrix is found singular; change() may still find it
  [[nodiscard]] bool factorise(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                               std::span<const LentSpring> springs, std::span<const Yield> yields);
  /// The same in two pieces.
  void fill(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N, std::span<const LentSpring> springs,
            std::span<const Yield> yields);
  [[nodiscard]] bool factorise_filled();

  /// Adds a contact after those there, without a spring.
  /// @param A, N [mm/N] (3g × 3g) with the new contact
  /// @return false, and nothing done, where it is better to factorise again
  [[nodiscard]] bool append(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N, const Yield& yield);

  /// Forgets all contacts but the first. @return false, and nothing done, where that takes a new factor
  [[nodiscard]] bool keep_first(int grips);

  /// Takes in other values of D; the contacts' directions stay those of factorise(). To be called before finish().
  /// @return false where a row that was to have no D gets one, or a contact that slides almost freely has turned:
  ///   factorise again; or, just after that, where the matrix is singular
  [[nodiscard]] bool change(std::span<const Yield> yields);

  /// Counts the matrices there have been: results of finish() depend on it.
  [[nodiscard]] std::uint64_t version() const { return version_; }

  /// Rows of a column: three per contact, two per spring.
  [[nodiscard]] Eigen::Index rows() const { return rows_.count(); }
  [[nodiscard]] Eigen::Index spring_rows() const { return rows_.spring_rows(); }

  // NOLINTBEGIN(performance-unnecessary-value-param): the results are written through their views
  /// Eᵀ y. @param y (3g) LPS @param along (rows of the springs) written
  void across(const Eigen::Ref<const VecX>& y, Eigen::Ref<VecX> along) const { springs_.across(y, along); }
  /// y += E f. @param f (rows of the springs) [N] @param y (3g) LPS
  void add_lent(const Eigen::Ref<const VecX>& f, Eigen::Ref<VecX> y) const { springs_.add_forces(f, y); }
  // NOLINTEND(performance-unnecessary-value-param)

  /// The part of Y ← B⁻¹ Y that does not depend on D: it remains valid until the matrix is factorised, grows or
  /// shrinks.
  /// @param Y (rows × k), at most kMostColumns columns; its rows are in the order of elimination afterwards
  void begin(Eigen::Ref<MatX> Y);
  /// The rest of it, with the present D. @param Y as begin() left it
  void finish(Eigen::Ref<MatX> Y);
  static constexpr int kMostColumns = 5;

  /// D of a contact as it is in the matrix.
  [[nodiscard]] const Yield& yield(int grip) const { return yields_[static_cast<std::size_t>(grip)]; }

 private:
  [[nodiscard]] double& lower(Eigen::Index a, Eigen::Index b) { return factor_(std::max(a, b), std::min(a, b)); }
  [[nodiscard]] Eigen::Index spring_place(int spring) const { return rows_.settled() + 2 * spring; }
  void fill_contacts(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N);
  void fill_springs(const Eigen::Ref<const MatX>& A);
  void begin_yielding();
  void set_yield(int grip, int k, double value);

  GripRows rows_;
  LentSprings springs_;
  std::vector<Yield> yields_;       ///< (g) as they are in the matrix
  std::vector<double> compliance_;  ///< (g) [mm/N] of needle and tissue at each contact, mean of the three directions
  int appended_ = 0;                ///< contacts added since factorise()
  /// Lower triangle of B without D, in the order of elimination. Settled columns hold the Cholesky factor L, down to
  /// the last row; the others hold what elimination of the settled rows leaves of B. In the upper triangle nothing is
  /// read but the inverses of tiles (dense_cholesky.hpp).
  MatX factor_;
  YieldingRows yielding_;
  std::uint64_t version_ = 0;
  MatX work_;    ///< (rows × most columns) columns in the order of elimination
  MatX sum_;     ///< (3g × 3) columns of a contact in A + N, in LPS
  MatX turned_;  ///< (3g × 3) the same with the contact's own directions as columns
};

}  // namespace stylet
