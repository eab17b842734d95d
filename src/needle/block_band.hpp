// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <algorithm>
#include <vector>

namespace stylet::tet {

inline constexpr int kBlock = 15;  ///< unknowns of a cross-section
using Block = Eigen::Matrix<double, kBlock, kBlock>;

/// Symmetric positive definite matrix of 15 × 15 blocks, zero more than a few blocks off the diagonal, and its Cholesky
/// factor in the same place; each row of blocks has its own width. Nothing allocates after construction.
class BlockBand {
 public:
  static constexpr int kWidest = 3;  ///< blocks beside the diagonal

  explicit BlockBand(int blocks);

  /// All blocks zero; only the diagonal and the blocks next to it are in use.
  void clear();

  [[nodiscard]] int blocks() const { return blocks_; }
  /// Block (row, column), column ≤ row ≤ column + kWidest, from now on in use. Of diagonal blocks the lower triangle
  /// counts.
  [[nodiscard]] Block& at(int row, int column) {
    int& first = first_[static_cast<std::size_t>(row)];
    first = std::min(first, column);
    return block(row, column);
  }

  /// A = L Lᵀ, L over A. @return false if A is not positive definite (A is then spoilt)
  [[nodiscard]] bool factorise();

  /// y ← L⁻¹ y from block `start` on; what lies before it is zero and stays so. y: (15 blocks) doubles
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
  std::vector<int> first_;  ///< of each row, the first block in use
  std::vector<Block> block_;
};

}  // namespace stylet::tet
