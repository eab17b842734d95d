// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/block_band.hpp"

#include <algorithm>
#include <cmath>

/// Plain loops of fixed length: the compiler unrolls and vectorises them, and library products of this size would spend
/// more on their set-up than on the arithmetic.
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

void BlockBand::clear(int band) {
  band_ = band;
  for (Block& block : block_) block.setZero();
}

bool BlockBand::factorise() {
  for (int row = 0; row < blocks_; ++row) {
    const int first = std::max(0, row - band_);
    for (int column = first; column < row; ++column) {
      Block& A = (*this)(row, column);
      for (int k = std::max(first, column - band_); k < column; ++k)
        subtract_product(A, (*this)(row, k), (*this)(column, k));
      divide_by_transpose(A, (*this)(column, column));
    }
    Block& diagonal = (*this)(row, row);
    for (int k = first; k < row; ++k) subtract_product(diagonal, (*this)(row, k), (*this)(row, k));
    if (!factorise_block(diagonal)) return false;
  }
  return true;
}

void BlockBand::solve_lower(int first, double* y) const {
  for (int row = first; row < blocks_; ++row) {
    double x[kBlock];
    double* const here = y + row * kBlock;
    for (int i = 0; i < kBlock; ++i) x[i] = here[i];
    for (int k = std::max(first, row - band_); k < row; ++k) {
      const Block& L = (*this)(row, k);
      const double* const known = y + k * kBlock;
      for (int j = 0; j < kBlock; ++j) {
        const double v = known[j];
        for (int i = 0; i < kBlock; ++i) x[i] -= L(i, j) * v;
      }
    }
    const Block& L = (*this)(row, row);
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
    for (int k = row + 1; k <= std::min(blocks_ - 1, row + band_); ++k) {
      const Block& L = (*this)(k, row);
      const double* const known = y + k * kBlock;
      for (int j = 0; j < kBlock; ++j) {
        double sum = 0.0;
        for (int i = 0; i < kBlock; ++i) sum += L(i, j) * known[i];
        here[j] -= sum;
      }
    }
    const Block& L = (*this)(row, row);
    for (int j = kBlock - 1; j >= 0; --j) {
      double sum = here[j];
      for (int i = j + 1; i < kBlock; ++i) sum -= L(i, j) * here[i];
      here[j] = sum / L(j, j);
    }
  }
}

}  // namespace stylet::tet
