// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace stylet {

/// What a contact gives way by itself: D = lateral I + (axial − lateral) t tᵀ.
struct Yield {
  Vec3 along = Vec3::UnitZ();  ///< t, unit, LPS; zero: in all directions, at the tip only
  double lateral = 0.0;        ///< [mm/N]
  double axial = 0.0;          ///< [mm/N]

  [[nodiscard]] Vec3 of(const Vec3& force) const {
    return lateral * force + ((axial - lateral) * along.dot(force)) * along;
  }
};

/// A spring that is lent to the needle at a contact, across it: G = k (I − t tᵀ).
struct LentSpring {
  Vec3 along = Vec3::UnitZ();  ///< t, unit, LPS; zero: in all directions, at the tip only
  double stiffness = 0.0;      ///< k [N/mm]; 0 = none

  [[nodiscard]] Mat3 matrix() const { return stiffness * (Mat3::Identity() - along * along.transpose()); }
};

/// Matrix of the equations of the shaft's contacts, all held in all directions (ContactSystem has the derivation):
///   B = [P + N,  P E;  Eᵀ P,  Eᵀ P E − K⁻¹],  P = A + diag(D),
/// A and N being the tissue's and the needle's compliance, E the two directions of each lent spring and K their
/// stiffness. P + N is symmetric positive definite.
///
/// It is factorised once and used over many steps. What changes meanwhile is D: contacts come to slide or to hold, and
/// young ones grow hard. So rows that have no D and will have none, across the needle at contacts that have come of
/// age, are eliminated first and for good; not those of the last three, next to the tip. What is left of the others,
/// two fifths of all, is a small matrix to which D of now is added on its diagonal; that one is factorised again for
/// each D, however many contacts change. Springs come last.
///
/// Columns have 3g rows of the contacts, LPS, then two a spring. Sized once; nothing allocates after that.
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
  /// @param A, N [mm/N] (3g × 3g) with it
  /// @return false, and nothing done, where it is better to factorise again
  [[nodiscard]] bool append(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N, const Yield& yield);

  /// Forgets all contacts but the first. @return false, and nothing done, where that takes a new factor
  [[nodiscard]] bool keep_first(int grips);

  /// Takes other values of D in; directions stay those of factorise(). To be called before finish().
  /// @return false where a row that was to have none gets a D, or a contact that slides almost freely has turned:
  ///   factorise again; or, just after that, where the matrix is singular
  [[nodiscard]] bool change(std::span<const Yield> yields);

  /// Counts the matrices there have been: finish() depends on it.
  [[nodiscard]] std::uint64_t version() const { return version_; }

  /// Rows of a column: three a contact, two a spring.
  [[nodiscard]] Eigen::Index rows() const { return grip_rows() + spring_rows(); }
  [[nodiscard]] Eigen::Index grip_rows() const { return 3 * static_cast<Eigen::Index>(grips_); }
  [[nodiscard]] Eigen::Index spring_rows() const { return 2 * static_cast<Eigen::Index>(springs_.size()); }

  /// Eᵀ y. @param y (3g) LPS @param along (rows of the springs) written
  void across(const Eigen::Ref<const VecX>& y, Eigen::Ref<VecX> along) const;
  /// y += E f. @param f (rows of the springs) [N] @param y (3g) LPS
  void add_lent(const Eigen::Ref<const VecX>& f, Eigen::Ref<VecX> y) const;

  /// The part of Y ← B⁻¹ Y that does not know D: good until the matrix is factorised, grows or shrinks.
  /// @param Y (rows × k), at most kMostColumns; its rows are in no order then
  void begin(Eigen::Ref<MatX> Y);
  /// The rest of it, with D of now. @param Y as begin() left it
  void finish(Eigen::Ref<MatX> Y);
  static constexpr int kMostColumns = 5;

  /// D of a contact as it is in the matrix.
  [[nodiscard]] const Yield& yield(int grip) const { return yields_[static_cast<std::size_t>(grip)]; }

 private:
  struct Spring {
    int grip = 0;
    Eigen::Matrix<double, 3, 2> E = Eigen::Matrix<double, 3, 2>::Zero();      ///< LPS
    Eigen::Matrix<double, 3, 2> local = Eigen::Matrix<double, 3, 2>::Zero();  ///< in the contact's frame
  };
  /// Where a row of a contact, in its frame (n1, n2, t), is in the order of elimination: those that stay, the springs,
  /// those that change.
  [[nodiscard]] Eigen::Index& place(int grip, int k) {
    return place_[3 * static_cast<std::size_t>(grip) + static_cast<std::size_t>(k)];
  }
  [[nodiscard]] Eigen::Index place(int grip, int k) const {
    return place_[3 * static_cast<std::size_t>(grip) + static_cast<std::size_t>(k)];
  }
  [[nodiscard]] bool stays(int grip, int k) const { return place(grip, k) < staying_; }
  [[nodiscard]] Eigen::Index changing() const { return rows() - staying_ - spring_rows(); }
  [[nodiscard]] double& lower(Eigen::Index a, Eigen::Index b) { return factor_(std::max(a, b), std::min(a, b)); }
  [[nodiscard]] const Mat3& frame(int grip) const { return frames_[static_cast<std::size_t>(grip)]; }
  void take_springs(std::span<const LentSpring> springs);
  void order(std::span<const Yield> yields);
  void fill_contacts(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N);
  void fill_springs(const Eigen::Ref<const MatX>& A);
  void outdate(Eigen::Index row);
  [[nodiscard]] bool factorise_changing();
  [[nodiscard]] Eigen::RowVector2d own(const Spring& spring, int k) const;

  int grips_ = 0;
  int appended_ = 0;                 ///< contacts since factorise()
  Eigen::Index staying_ = 0;         ///< rows that stay without D
  std::vector<Eigen::Index> place_;  ///< (3g)
  std::vector<Mat3> frames_;         ///< (g) n1, n2, t of each contact as the rows have it
  std::vector<Yield> yields_;        ///< (g) in the matrix
  std::vector<double> own_;          ///< [mm/N] what needle and tissue give way at a contact, mean of the directions
  std::vector<Spring> springs_;
  std::vector<double> flexibility_;  ///< [mm/N] K⁻¹ of each spring
  /// Lower triangle of B, without D, in the order of elimination. Of the rows that stay L; of the others what they are
  /// in L, and right of that what B has left of them. In the upper triangle nothing but the inverses of tiles is read
  /// (dense_cholesky.hpp).
  MatX factor_;
  bool current_ = false;             ///< what follows is of D and contacts of now, …
  Eigen::Index current_before_ = 0;  ///< … or at least changing_ before this column
  std::uint64_t version_ = 0;
  MatX changing_;            ///< (c × c) L of the rows that change
  MatX by_springs_;          ///< (c × s) L⁻¹ of the springs' columns there
  MatX left_;                ///< (s × s) what is left for the springs: L and U
  std::vector<int> pivots_;  ///< (s)
  MatX work_;                ///< (rows × most columns)
  MatX sum_;                 ///< (3g × 3) columns of a contact in A + N, …
  MatX turned_;              ///< … and in its frame
};

}  // namespace stylet
