// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/needle/needle.hpp"

namespace stylet::beam {

/// A symmetric matrix H and the Cholesky factor of H + shift I. The shift is zero if H is positive definite, and
/// otherwise large enough to make the sum positive definite. Nothing allocates after construction.
class ShiftedFactor {
 public:
  /// Starts with H = 0 and the factor of the unit matrix.
  explicit ShiftedFactor(Eigen::Index size);

  /// The matrix H, of which only the lower triangle is used. Writing it does not change the factor.
  [[nodiscard]] MatX& matrix() { return H_; }
  [[nodiscard]] const MatX& matrix() const { return H_; }

  /// Factorises H.
  /// @param otherwise what to do when H is not positive definite
  /// @return false when it gave up; there is no factor then
  bool factorise(Indefinite otherwise);
  /// Whether the last factorise() made a factor.
  [[nodiscard]] bool factorised() const { return factorised_; }
  /// The shift of the last attempt; 0 when H is positive definite.
  [[nodiscard]] double shift() const { return shift_; }

  /// Y ← L⁻¹ Y for columns whose rows before `start` are zero. @param Y (size × k)
  void solve_lower(Eigen::Index start, Eigen::Ref<MatX> Y) const;
  /// Y ← L⁻ᵀ Y
  void solve_upper(Eigen::Ref<MatX> Y) const;

 private:
  [[nodiscard]] bool attempt(double shift);

  MatX H_;
  MatX L_;  ///< the factor in the lower triangle, with the inverses of its tiles above (dense_cholesky.hpp)
  double shift_ = 0.0;
  bool factorised_ = false;
};

}  // namespace stylet::beam
