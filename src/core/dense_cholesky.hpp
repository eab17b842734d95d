// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/dense_kernels.hpp"
#include "stylet/core/types.hpp"

/// Dense Cholesky factorisation in place. Matrices are processed in tiles so small that Eigen's products keep their
/// work space on the stack for any matrix size: nothing here allocates. Only the lower triangle of A is read. The
/// factor overwrites it, and the inverses of the diagonal tiles are written into the upper triangle, which makes
/// solve_lower() and solve_upper() fast. The solvers accept only factors made by the functions here, whole or cut to
/// their leading rows and columns; the tiles begin at multiples of kTile.
namespace stylet::dense {

/// Factorises A = L Lᵀ; L overwrites A. @return false if A is not positive definite (A is then destroyed)
[[nodiscard]] bool factorise(Eigen::Ref<MatX> A);

/// Continues a factorisation: the columns before `first`, a multiple of kTile, already contain L.
[[nodiscard]] bool factorise_from(Eigen::Ref<MatX> A, Eigen::Index first);

/// Factorises the leading columns only, over all rows. The remaining columns then contain the Schur complement.
[[nodiscard]] bool factorise_first(Eigen::Ref<MatX> A, Eigen::Index columns);

/// Y ← L⁻¹ Y for a block of columns whose rows before `start` are zero.
void solve_lower(const Eigen::Ref<const MatX>& L, Eigen::Index start, Eigen::Ref<MatX> Y);

/// Y ← L⁻ᵀ Y
void solve_upper(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> Y);

}  // namespace stylet::dense
