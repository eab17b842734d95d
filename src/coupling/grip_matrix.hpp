// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <span>
#include <vector>

namespace stylet {

/// What a contact gives way by itself: D = lateral I + (axial − lateral) t tᵀ.
struct Yield {
  Vec3 along = Vec3::UnitZ();  ///< t, unit, LPS
  double lateral = 0.0;        ///< [mm/N]
  double axial = 0.0;          ///< [mm/N]

  [[nodiscard]] Vec3 of(const Vec3& force) const {
    return lateral * force + ((axial - lateral) * along.dot(force)) * along;
  }
};

/// Matrix of the equations of the shaft's contacts, all held in all directions (ContactSystem has the derivation):
///   B = P (I − G N) + N,  P = A + diag(D),
/// A and N being the tissue's and the needle's compliance, G springs lent to the needle or nothing. Without springs B
/// is symmetric positive definite.
///
/// It is factorised once and used over many steps: contacts that come to slide or to hold change D in a few directions,
/// B' = B + E Δ Fᵀ with F = (I − G N)ᵀ E, and Woodbury's formula takes them in. LPS, three rows a contact. Sized once;
/// nothing allocates after that.
class GripMatrix {
 public:
  static constexpr int kMostChanges = 12;

  explicit GripMatrix(int grips);

  /// @param A, N [mm/N] (3g × 3g) @param springs [N/mm] (g) G, or none @param yields (g)
  /// @return false where the matrix is singular
  [[nodiscard]] bool factorise(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                               std::span<const Mat3> springs, std::span<const Yield> yields);

  /// Adds a contact after those there; no spring is lent at it. The others are as factorise() left them.
  /// @param A, N [mm/N] (3g × 3g) with it @param springs [N/mm] (g), or none if factorise() had none
  /// @return false where the matrix is singular; factorise again
  [[nodiscard]] bool append(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                            std::span<const Mat3> springs, const Yield& yield);

  /// Puts other values of D in; directions stay those of factorise().
  /// @return false, and nothing done, when more than kMostChanges differ, or a contact that slides almost freely has
  ///   turned: factorise again
  [[nodiscard]] bool change(std::span<const Yield> yields);

  /// Forgets all contacts but the first. @return false, and nothing done, where that takes a new factor
  [[nodiscard]] bool keep_first(int grips);

  /// Y ← B₀⁻¹ Y, with D as factorise() or append() had it.
  void solve_base(Eigen::Ref<MatX> Y) const;

  /// From B₀⁻¹ C₀ to B⁻¹ C with D of now, where C = C₀ − ΔD lent: what D has to do with a column, if anything.
  /// @param Y (3g × k) B₀⁻¹ C₀, becomes B⁻¹ C @param lent (3g × k), or (0 × 0)
  void take_changes_in(Eigen::Ref<MatX> Y, const Eigen::Ref<const MatX>& lent) const;

  /// D of a contact as it is in the matrix.
  [[nodiscard]] Yield yield(int grip) const;
  /// D of a contact in B₀.
  [[nodiscard]] const Yield& yield_of_factor(int grip) const { return yields_[static_cast<std::size_t>(grip)]; }

 private:
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostChanges, kMostChanges>;
  using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostChanges, 1>;

  /// A direction in which D has changed.
  struct Direction {
    int grip = 0;
    Vec3 e = Vec3::Zero();
    double change = 0.0;  ///< [mm/N]
  };
  [[nodiscard]] Eigen::Index lent_rows() const { return 3 * static_cast<Eigen::Index>(lent_.size()); }
  void forget_changes();
  int forget_unchanged(std::span<const Yield> yields);
  int direction(int grip, int which);
  [[nodiscard]] double across(const Direction& d, const Eigen::Ref<const VecX>& y) const;

  int grips_ = 0;
  bool supported_ = false;
  std::vector<int> lent_;               ///< grips with a spring
  std::vector<int> lent_row_;           ///< (g) where their rows of G N begin, -1 without a spring
  MatX factor_;                         ///< of B as factorised: L, or L and U
  MatX P_lent_;                         ///< (3g × 3 springs) columns of P at the springs
  MatX G_N_;                            ///< (3 springs × 3g) rows of G N there
  MatX row_;                            ///< (3 × 3g) of a contact that is appended
  std::vector<int> pivots_;             ///< with springs
  std::vector<double> own_;             ///< [mm/N] what needle and tissue give way at a contact, mean of the directions
  std::vector<Yield> yields_;           ///< as factorised
  std::vector<Eigen::Vector3i> known_;  ///< (g) numbers of the directions two lateral, axial; -1 unknown
  std::array<Direction, kMostChanges> directions_;
  int count_ = 0;         ///< of directions
  bool changed_ = false;  ///< any with a change other than 0
  MatX Z_;                ///< (3g × directions) B⁻¹ E
  Small F_Z_;             ///< Fᵀ Z
};

}  // namespace stylet
