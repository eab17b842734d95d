// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/needle/needle.hpp"

namespace stylet::beam {

/// A symmetric matrix H and the Cholesky factor of H + shift I, where the shift is zero if H is positive definite and
/// else large enough for the sum to be so. Nothing allocates after construction.
class ShiftedFactor {
 public:
  /// H is zero then, and the factor that of the unit matrix.
  explicit ShiftedFactor(Eigen::Index size);

  /// H, of which the lower triangle counts. Writing it does not change the factor.
  [[nodiscard]] MatX& matrix() { return H_; }
  [[nodiscard]] const MatX& matrix() const { return H_; }

  /// Factorises H. @param otherwise what to do where H is not positive definite
  /// @return false where it was given up: there is no factor then
  bool factorise(Indefinite otherwise);
  /// Whether the last factorise() made a factor.
  [[nodiscard]] bool factorised() const { return factorised_; }
  /// The shift of the last attempt; 0 where H is positive definite.
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
