// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <algorithm>
#include <vector>

namespace stylet::tet {

inline constexpr int kBlock = 15;  ///< number of unknowns of a cross-section
using Block = Eigen::Matrix<double, kBlock, kBlock>;

/// A symmetric positive definite matrix of 15 × 15 blocks that is zero further than kWidest blocks off the diagonal,
/// and its Cholesky factor in the same memory. Each row of blocks has its own width. Nothing allocates after
/// construction.
class BlockBand {
 public:
  static constexpr int kWidest = 3;  ///< largest number of blocks beside the diagonal

  explicit BlockBand(int blocks);

  /// Sets all blocks to zero, and the width of each row to the diagonal and the block next to it.
  void clear();

  [[nodiscard]] int blocks() const { return blocks_; }
  /// Block (row, column) with column ≤ row ≤ column + kWidest; widens the row to include it. Only the lower triangle of
  /// diagonal blocks is used.
  [[nodiscard]] Block& at(int row, int column) {
    int& first = first_[static_cast<std::size_t>(row)];
    first = std::min(first, column);
    return block(row, column);
  }

  /// Factorises A = L Lᵀ; L overwrites A. @return false if A is not positive definite (A is then destroyed)
  [[nodiscard]] bool factorise();

  /// y ← L⁻¹ y for a y of (15 blocks) numbers that is zero before block `start`.
  void solve_lower(int start, double* y) const;
  /// y ← L⁻ᵀ y
  void solve_upper(double* y) const;

 private:
  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row * (kWidest + 1) + row - column);
  }
  [[nodiscard]] Block& block(int row, int column) { return block_[index(row, column)]; }
  [[nodiscard]] const Block& block(int row, int column) const { return block_[index(row, column)]; }
  [[nodiscard]] int first(int row) const { return first_[static_cast<std::size_t>(row)]; }

  int blocks_;
  std::vector<int> first_;  ///< number of the first block in use in each row
  std::vector<Block> block_;
};

}  // namespace stylet::tet
