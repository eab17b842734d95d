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

/// Matrix of the equations of the shaft contacts, all held in all directions (ContactSystem has the derivation):
///   B = [P + N,  P E;  Eᵀ P,  Eᵀ P E − K⁻¹],  P = A + diag(D),
/// where A and N are the tissue's and the needle's compliance, E holds the two directions of each lent spring, and K
/// their stiffness. P + N is symmetric positive definite.
///
/// The matrix is factorised once and used over many steps. In the meantime only D changes, because contacts begin to
/// slide or to stick and because young contacts harden. Therefore rows whose D is zero and stays zero are eliminated
/// first, once (GripRows). The remaining rows, two fifths of all, form a small matrix, which is factorised again
/// whenever D changes, for any number of contacts (YieldingRows).
///
/// Columns have three rows for each contact in LPS, 3g in all, and then two for each spring. Nothing allocates after
/// construction.
class GripMatrix {
 public:
  explicit GripMatrix(int grips);

  /// @param A, N [mm/N] (3g × 3g) @param springs (g), or none @param yields (g)
  /// @return false where the matrix is found singular; change() may still find it
  [[nodiscard]] bool factorise(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                               std::span<const LentSpring> springs, std::span<const Yield> yields);
  /// The same in two pieces, which may be done in different steps.
  void fill(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N, std::span<const LentSpring> springs,
            std::span<const Yield> yields);
  [[nodiscard]] bool factorise_filled();

  /// Adds a contact after the present ones, without a spring.
  /// @param A, N [mm/N] (3g × 3g) with the new contact
  /// @return false, with nothing changed, where a new factorisation is better
  [[nodiscard]] bool append(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N, const Yield& yield);

  /// Removes all contacts but the first `grips`. @return false, with nothing changed, where that needs a new
  /// factorisation
  [[nodiscard]] bool keep_first(int grips);

  /// Changes the values of D; the contacts' directions stay those of factorise(). To be called before finish().
  /// @return false where a settled row would get a D, or where a contact that slides almost freely has turned: call
  /// factorise(). False directly after factorise() means that the matrix is singular.
  [[nodiscard]] bool change(std::span<const Yield> yields);

  /// Counts the changes of the matrix that change the results of finish().
  [[nodiscard]] std::uint64_t version() const { return version_; }

  /// Rows of a column: three for each contact, two for each spring.
  [[nodiscard]] Eigen::Index rows() const { return rows_.count(); }
  [[nodiscard]] Eigen::Index spring_rows() const { return rows_.spring_rows(); }

  // NOLINTBEGIN(performance-unnecessary-value-param): the results are written through their views
  /// Eᵀ y. @param y (3g) LPS @param along (2 for each spring) written
  void across(const Eigen::Ref<const VecX>& y, Eigen::Ref<VecX> along) const { springs_.across(y, along); }
  /// y += E f. @param f (2 for each spring) [N] @param y (3g) LPS
  void add_lent(const Eigen::Ref<const VecX>& f, Eigen::Ref<VecX> y) const { springs_.add_forces(f, y); }
  // NOLINTEND(performance-unnecessary-value-param)

  /// The part of Y ← B⁻¹ Y that does not depend on D: it remains valid until the matrix is factorised, grows or
  /// shrinks.
  /// @param Y (rows × k), at most kMostColumns columns; its rows are in the order of elimination afterwards
  void begin(Eigen::Ref<MatX> Y);
  /// The remaining part, with the present D. @param Y as begin() left it
  void finish(Eigen::Ref<MatX> Y);
  static constexpr int kMostColumns = 5;

  /// D of a contact in the matrix.
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
  std::vector<Yield> yields_;       ///< (g) D in the matrix
  std::vector<double> compliance_;  ///< (g) [mm/N] of needle and tissue at each contact, mean over the three directions
  int appended_ = 0;                ///< contacts added since factorise()
  /// Lower triangle of B without D, in the order of elimination. Settled columns hold the Cholesky factor L down to the
  /// last row; the other columns hold the Schur complement that elimination of the settled rows leaves. Of the upper
  /// triangle, only the inverses of tiles are read (dense_cholesky.hpp).
  MatX factor_;
  YieldingRows yielding_;
  std::uint64_t version_ = 0;
  MatX work_;    ///< (rows × kMostColumns) columns in the order of elimination
  MatX sum_;     ///< (3g × 3) columns of a contact in A + N, in LPS
  MatX turned_;  ///< (3g × 3) the same, with respect to the contact's own directions
};

}  // namespace stylet
