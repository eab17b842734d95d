// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/dense_kernels.hpp"
#include "stylet/core/types.hpp"

/// Dense Cholesky in place, cut into tiles so small that Eigen's products keep their work space on the stack at any
/// size: nothing here allocates. Of A only the lower triangle is read; above those of the tiles on the diagonal their
/// inverses are written, with which solve_lower() and solve_upper() are quick. These take a factor of the functions
/// here, the whole of it or its first columns and rows; their tiles begin at multiples of kTile.
namespace stylet::dense {

/// A = L Lᵀ, L over A. @return false if A is not positive definite (A is then spoilt)
[[nodiscard]] bool factorise(Eigen::Ref<MatX> A);

/// The same where the columns before `first`, a multiple of kTile, are L already.
[[nodiscard]] bool factorise_from(Eigen::Ref<MatX> A, Eigen::Index first);

/// The first columns of that only, down to the last row; what A has left of the other columns is in their place.
[[nodiscard]] bool factorise_first(Eigen::Ref<MatX> A, Eigen::Index columns);

/// Y ← L⁻¹ Y for a block of columns whose rows before `start` are zero.
void solve_lower(const Eigen::Ref<const MatX>& L, Eigen::Index start, Eigen::Ref<MatX> Y);

/// Y ← L⁻ᵀ Y
void solve_upper(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> Y);

}  // namespace stylet::dense
