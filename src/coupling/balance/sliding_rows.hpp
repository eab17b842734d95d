// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/resting_matrix.hpp"

#include <span>
#include <vector>

namespace stylet {

/// The contacts of needles at rest that slide: each yields along its needle by `more` than in the matrix B
/// (RestingMatrix). With a unit vector e along the needle for each of them, as columns of E, Woodbury's formula gives
///   (B + E diag(more) Eᵀ)⁻¹ = B⁻¹ − Z (diag(1/more) + Eᵀ Z)⁻¹ Eᵀ B⁻¹,   Z = B⁻¹ E.
/// A column of Z is kept when its contact sticks again. Nothing allocates after construction.
class SlidingRows {
 public:
  explicit SlidingRows(int grips);

  /// Forgets all columns: B is new.
  void clear();

  enum class Change { none, some, needs_new_matrix };
  /// Follows the present D of all contacts.
  [[nodiscard]] Change follow(std::span<const Yield> yields, RestingMatrix& matrix);

  /// Whether follow() would change something.
  [[nodiscard]] bool differs(std::span<const Yield> yields, const RestingMatrix& matrix) const;

  /// Number of sliding contacts.
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(sliding_.size()); }
  /// Number of a sliding contact among those at rest, from 0 on.
  [[nodiscard]] int grip(Eigen::Index j) const { return sliding_[static_cast<std::size_t>(j)].grip; }
  /// eᵀ z of a contact whose column is known.
  [[nodiscard]] double along(const Eigen::Ref<const VecX>& z, int grip, const RestingMatrix& matrix) const;
  /// [mm/N] Yield of a contact along its needle beyond that in B.
  [[nodiscard]] double more(int grip) const;

  /// Solves for B⁻¹ e of a contact if it is not known yet.
  void know(int grip, RestingMatrix& matrix) {
    if (!known_[static_cast<std::size_t>(grip)].known) solve_column(grip, matrix);
  }
  /// B⁻¹ e of a contact that is known, as those that slide are (rows).
  [[nodiscard]] auto column(int grip, const RestingMatrix& matrix) const {
    return columns_.col(grip).head(matrix.rows());
  }

  // NOLINTBEGIN(performance-unnecessary-value-param): the results are written through their views
  /// Zᵀ Y. @param Y (rows × k) @param of (count × k) written
  void answer(const Eigen::Ref<const MatX>& Y, const RestingMatrix& matrix, Eigen::Ref<MatX> of) const {
    for (Eigen::Index j = 0; j < count(); ++j)
      of.row(j) = column(sliding_[static_cast<std::size_t>(j)].grip, matrix).transpose().lazyProduct(Y);
  }
  /// Adds Zᵀ Y for Y whose rows are zero but for those from `from` on. @param of (count × k, or larger)
  void add_answers(Eigen::Index from, const Eigen::Ref<const MatX>& Y, const RestingMatrix& matrix,
                   Eigen::Ref<MatX> of) const {
    for (Eigen::Index j = 0; j < count(); ++j) {
      const auto part = column(grip(j), matrix).segment(from, Y.rows());
      of.row(j).head(Y.cols()) += part.transpose().lazyProduct(Y);
    }
  }
  /// Eᵀ Z̃ for solved columns. @param columns (rows × k) @param of (count × k) written
  void take(const Eigen::Ref<const MatX>& columns, const RestingMatrix& matrix, Eigen::Ref<MatX> of) const;
  /// Y ← (diag(1/more) + Eᵀ Z)⁻¹ Y. @param Y (count × k)
  void divide(Eigen::Ref<MatX> Y) const;
  /// The same for Eᵀ z. @return a view of work space (count), valid until the next call
  [[nodiscard]] Eigen::Ref<const VecX> slips(const Eigen::Ref<const VecX>& z, const RestingMatrix& matrix);
  /// Lets the sliding contacts yield in a solved column. @param z (rows) changed
  void yield_in(Eigen::Ref<VecX> z, const RestingMatrix& matrix);
  // NOLINTEND(performance-unnecessary-value-param)

 private:
  struct Sliding {
    int grip = 0;
    double more = 0.0;
  };
  /// A column of Z, and the part of its e in the rows of a spring: the needle has turned since the spring was lent.
  struct Column {
    bool known = false;
    Eigen::Index row = -1;                            ///< first of the spring's rows; −1: none
    Eigen::Vector2d along = Eigen::Vector2d::Zero();  ///< e in these rows
  };

  void solve_column(int grip, RestingMatrix& matrix);
  [[nodiscard]] bool is_as(std::size_t j, int grip, double more) const;

  std::vector<Sliding> sliding_;
  std::vector<Column> known_;  ///< (grips)
  MatX columns_;               ///< (rows × grips) Z
  MatX factors_;               ///< (count × count) LU factors
  std::vector<int> pivots_;
  VecX slips_;
};

}  // namespace stylet
