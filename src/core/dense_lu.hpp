// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <span>

/// Dense LU factorisation with partial pivoting in place. Matrices are processed in tiles so small that Eigen's
/// products keep their work space on the stack for any matrix size: nothing here allocates.
namespace stylet::dense {

/// Factorises P A = L U; both overwrite A (L has a unit diagonal).
/// @param pivots (n) output: the row that was swapped with row k
/// @return false when A is singular to working precision (A is then destroyed)
[[nodiscard]] bool factorise_lu(Eigen::Ref<MatX> A, std::span<int> pivots);

/// Y ← A⁻¹ Y, from the factors that factorise_lu() made.
void solve_lu(const Eigen::Ref<const MatX>& LU, std::span<const int> pivots, Eigen::Ref<MatX> Y);

}  // namespace stylet::dense
