// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <span>

/// The inner loops of the dense solvers: small matrices, column after column in memory, no work space. On processors
/// that multiply and add at once (FMA) its instructions are used, and all of these give the same results: sums are
/// taken in the same order everywhere, which may be another one for one column than for many. Older ones round each
/// product.
namespace stylet::dense {

/// Tiles have no more rows and columns.
inline constexpr Eigen::Index kTile = 24;

/// Rows that a matrix of so many rows had best have: columns that begin at other places in the processor's registers
/// each are slow to load.
constexpr Eigen::Index column_length(Eigen::Index rows) { return (rows + 3) / 4 * 4; }

/// C ← C − A B, element (i, j) over k = 0, 1, … in turn.
void subtract_product(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B);

/// C ← C − A Bᵀ
void subtract_product_transposed(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B);

/// C ← Aᵀ B
void transposed_product(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B);

/// Σ_k A_k B_k over pairs of blocks; as many of one as of the other.
[[nodiscard]] Mat3 sum_of_products(std::span<const Mat3> A, std::span<const Mat3> B);

/// Y ← L⁻¹ Y for a small lower triangle L whose diagonal counts as ones.
void solve_lower_tile(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> Y);

/// Writes L⁻ᵀ of a lower triangle, at most a tile, L over it, without its diagonal: above that of L.
void invert_tile(Eigen::Ref<MatX> L);

/// Y ← L⁻¹ Y for such a tile. It has no chain of divisions, each of which waits for the one before.
void solve_inverted_tile(const Eigen::Ref<const MatX>& tile, Eigen::Ref<MatX> Y);

/// Y ← L⁻ᵀ Y
void solve_inverted_tile_transposed(const Eigen::Ref<const MatX>& tile, Eigen::Ref<MatX> Y);

/// Y ← U⁻¹ Y for a small upper triangle U.
void solve_upper_tile(const Eigen::Ref<const MatX>& U, Eigen::Ref<MatX> Y);

/// X ← X L⁻ᵀ
void divide_by_transposed_tile(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> X);

/// P A = L U for the columns first … first + count − 1 of A, as they are after those before them have been taken out:
/// from row `first` down, L with ones on its diagonal and U over them, rows swapped in these columns only.
/// @param tiny pivots no larger than this are none @param pivots (n) pivots[j] = row that was swapped with row j,
/// written
/// @return false when there is no pivot
[[nodiscard]] bool factorise_lu_panel(Eigen::Ref<MatX> A, Eigen::Index first, Eigen::Index count, double tiny,
                                      std::span<int> pivots);

/// A = L Lᵀ for a small A, L over its lower triangle. @return false when A is not positive definite
[[nodiscard]] bool factorise_tile(Eigen::Ref<MatX> A);

}  // namespace stylet::dense
