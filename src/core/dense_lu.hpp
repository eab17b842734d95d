// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <span>

/// Dense LU with partial pivoting in place, cut into tiles so small that Eigen's products keep their work space on the
/// stack at any size: nothing here allocates.
namespace stylet::dense {

/// P A = L U, both over A (L with a unit diagonal). @param pivots (n) row that row k was swapped with, written
/// @return false when A is singular to working precision (A is then spoilt)
[[nodiscard]] bool factorise_lu(Eigen::Ref<MatX> A, std::span<int> pivots);

/// Y ← A⁻¹ Y from the factors.
void solve_lu(const Eigen::Ref<const MatX>& LU, std::span<const int> pivots, Eigen::Ref<MatX> Y);

}  // namespace stylet::dense
