// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/block_band.hpp"

#include <algorithm>
#include <cmath>

/// Plain loops of constant length, which the compiler unrolls and vectorises. Library products of this size would spend
/// more time on their set-up than on the arithmetic.
namespace stylet::tet {

namespace {

/// A ← A − B Cᵀ
void subtract_product(Block& A, const Block& B, const Block& C) {
  for (int j = 0; j < kBlock; ++j) {
    double column[kBlock];
    for (int i = 0; i < kBlock; ++i) column[i] = A(i, j);
    for (int k = 0; k < kBlock; ++k) {
      const double c = C(j, k);
      for (int i = 0; i < kBlock; ++i) column[i] -= B(i, k) * c;
    }
    for (int i = 0; i < kBlock; ++i) A(i, j) = column[i];
  }
}

/// A ← A L⁻ᵀ
void divide_by_transpose(Block& A, const Block& L) {
  for (int j = 0; j < kBlock; ++j) {
    double column[kBlock];
    for (int i = 0; i < kBlock; ++i) column[i] = A(i, j);
    for (int k = 0; k < j; ++k) {
      const double l = L(j, k);
      for (int i = 0; i < kBlock; ++i) column[i] -= A(i, k) * l;
    }
    const double inverse = 1.0 / L(j, j);
    for (int i = 0; i < kBlock; ++i) A(i, j) = column[i] * inverse;
  }
}

bool factorise_block(Block& A) {
  for (int j = 0; j < kBlock; ++j) {
    for (int k = 0; k < j; ++k) {
      const double l = A(j, k);
      for (int i = j; i < kBlock; ++i) A(i, j) -= A(i, k) * l;
    }
    const double pivot = A(j, j);
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    const double inverse = 1.0 / std::sqrt(pivot);
    for (int i = j; i < kBlock; ++i) A(i, j) *= inverse;
  }
  return true;
}

}  // namespace

BlockBand::BlockBand(int blocks)
    : blocks_(blocks),
      first_(static_cast<std::size_t>(blocks)),
      block_(static_cast<std::size_t>(blocks * (kWidest + 1))) {
  clear();
}

void BlockBand::clear() {
  for (Block& block : block_) block.setZero();
  for (int row = 0; row < blocks_; ++row) first_[static_cast<std::size_t>(row)] = std::max(0, row - 1);
}

bool BlockBand::factorise() {
  for (int row = 0; row < blocks_; ++row) {
    for (int column = first(row); column < row; ++column) {
      Block& A = block(row, column);
      for (int k = std::max(first(row), first(column)); k < column; ++k)
        subtract_product(A, block(row, k), block(column, k));
      divide_by_transpose(A, block(column, column));
    }
    Block& diagonal = block(row, row);
    for (int k = first(row); k < row; ++k) subtract_product(diagonal, block(row, k), block(row, k));
    if (!factorise_block(diagonal)) return false;
  }
  return true;
}

void BlockBand::solve_lower(int start, double* y) const {
  for (int row = start; row < blocks_; ++row) {
    double x[kBlock];
    double* const here = y + row * kBlock;
    for (int i = 0; i < kBlock; ++i) x[i] = here[i];
    for (int k = std::max(start, first(row)); k < row; ++k) {
      const Block& L = block(row, k);
      const double* const known = y + k * kBlock;
      for (int j = 0; j < kBlock; ++j) {
        const double v = known[j];
        for (int i = 0; i < kBlock; ++i) x[i] -= L(i, j) * v;
      }
    }
    const Block& L = block(row, row);
    for (int j = 0; j < kBlock; ++j) {
      x[j] /= L(j, j);
      for (int i = j + 1; i < kBlock; ++i) x[i] -= L(i, j) * x[j];
    }
    for (int i = 0; i < kBlock; ++i) here[i] = x[i];
  }
}

void BlockBand::solve_upper(double* y) const {
  for (int row = blocks_ - 1; row >= 0; --row) {
    double* const here = y + row * kBlock;
    for (int k = row + 1; k <= std::min(blocks_ - 1, row + kWidest); ++k) {
      if (first(k) > row) continue;
      const Block& L = block(k, row);
      const double* const known = y + k * kBlock;
      for (int j = 0; j < kBlock; ++j) {
        double sum = 0.0;
        for (int i = 0; i < kBlock; ++i) sum += L(i, j) * known[i];
        here[j] -= sum;
      }
    }
    const Block& L = block(row, row);
    for (int j = kBlock - 1; j >= 0; --j) {
      double sum = here[j];
      for (int i = j + 1; i < kBlock; ++i) sum -= L(i, j) * here[i];
      here[j] = sum / L(j, j);
    }
  }
}

}  // namespace stylet::tet
