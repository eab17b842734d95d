// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <vector>

namespace stylet::tet {

inline constexpr int kBlock = 15;  ///< unknowns of a cross-section
using Block = Eigen::Matrix<double, kBlock, kBlock>;

/// Symmetric positive definite matrix of 15 × 15 blocks, zero more than a few blocks off the diagonal, and its Cholesky
/// factor in the same place. Nothing allocates after construction.
class BlockBand {
 public:
  static constexpr int kWidest = 3;  ///< blocks beside the diagonal

  explicit BlockBand(int blocks) : blocks_(blocks), block_(static_cast<std::size_t>(blocks) * (kWidest + 1)) {}

  /// All blocks zero; from now on at most `band` ≤ kWidest blocks beside the diagonal are in use.
  void clear(int band);

  [[nodiscard]] int blocks() const { return blocks_; }
  /// Block (row, column), column ≤ row ≤ column + band. Of diagonal blocks the lower triangle counts.
  [[nodiscard]] Block& operator()(int row, int column) { return block_[index(row, column)]; }
  [[nodiscard]] const Block& operator()(int row, int column) const { return block_[index(row, column)]; }

  /// A = L Lᵀ, L over A. @return false if A is not positive definite (A is then spoilt)
  [[nodiscard]] bool factorise();

  /// y ← L⁻¹ y from block `first` on; what lies before it is zero and stays so. y: (15 blocks) doubles
  void solve_lower(int first, double* y) const;
  /// y ← L⁻ᵀ y
  void solve_upper(double* y) const;

 private:
  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row * (kWidest + 1) + row - column);
  }

  int blocks_;
  int band_ = 1;
  std::vector<Block> block_;
};

}  // namespace stylet::tet
