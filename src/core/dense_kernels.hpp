// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <span>

/// Inner loops of the dense solvers: small matrices in column-major storage, no work space. Processors with fused
/// multiply-add (FMA) use it, and all of them give the same bits, because sums are taken in the same order everywhere.
/// This order may differ between one column and many columns. Processors without FMA round each product.
namespace stylet::dense {

/// Largest number of rows and columns of a tile.
inline constexpr Eigen::Index kTile = 24;

/// Number of rows to allocate for a matrix with `rows` rows: rounded up to a multiple of four, so that every column has
/// the same alignment. Columns of different alignment are slow to load.
constexpr Eigen::Index column_length(Eigen::Index rows) { return (rows + 3) / 4 * 4; }

/// C ← C − A B. Each element sums over k = 0, 1, … in this order.
void subtract_product(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B);

/// C ← C − A B for a symmetric A. Of a matrix that is too large for the cache only the lower triangle and the diagonal
/// tiles are read, in half the time.
void subtract_symmetric_product(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B);

/// C ← C − A Bᵀ
void subtract_product_transposed(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B);

/// C ← Aᵀ B
void transposed_product(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B);

/// Σ_k A_k B_k over pairs of blocks; both spans have the same length.
[[nodiscard]] Mat3 sum_of_products(std::span<const Mat3> A, std::span<const Mat3> B);

/// Y ← L⁻¹ Y for a lower triangle L of at most a tile, whose diagonal counts as ones.
void solve_lower_tile(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> Y);

/// Writes L⁻ᵀ, without its diagonal, into the strict upper triangle of a tile whose lower triangle is L.
void invert_tile(Eigen::Ref<MatX> L);

/// Y ← L⁻¹ Y for a tile that invert_tile() has prepared. It avoids a chain of divisions that wait for each other.
void solve_inverted_tile(const Eigen::Ref<const MatX>& tile, Eigen::Ref<MatX> Y);

/// Y ← L⁻ᵀ Y for a tile that invert_tile() has prepared.
void solve_inverted_tile_transposed(const Eigen::Ref<const MatX>& tile, Eigen::Ref<MatX> Y);

/// Y ← U⁻¹ Y for an upper triangle U of at most a tile.
void solve_upper_tile(const Eigen::Ref<const MatX>& U, Eigen::Ref<MatX> Y);

/// X ← X L⁻ᵀ
void divide_by_transposed_tile(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> X);

/// Factorises P A = L U for the columns first … first + count − 1 of A from row `first` down, after the columns before
/// them have been eliminated. L, with ones on its diagonal, and U overwrite A; rows are swapped in these columns only.
/// @param tiny a pivot whose magnitude is not above this counts as zero
/// @param pivots (n) output: pivots[j] is the row that was swapped with row j
/// @return false when a pivot is zero
[[nodiscard]] bool factorise_lu_panel(Eigen::Ref<MatX> A, Eigen::Index first, Eigen::Index count, double tiny,
                                      std::span<int> pivots);

/// Factorises A = L Lᵀ for A of at most a tile; L overwrites the lower triangle. @return false when A is not positive
/// definite
[[nodiscard]] bool factorise_tile(Eigen::Ref<MatX> A);

}  // namespace stylet::dense
