// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dense_lu.hpp"

#include "core/dense_product.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::dense {

namespace {

constexpr double kSingular = 1e-14;

/// The columns k … k + nk − 1 by themselves, from row k down; rows are swapped in these columns only.
bool factorise_panel(Eigen::Ref<MatX> A, Eigen::Index k, Eigen::Index nk, double tiny, std::span<int> pivots) {
  const Eigen::Index n = A.rows();
  for (Eigen::Index j = k; j < k + nk; ++j) {
    Eigen::Index pivot = 0;
    const double largest = A.col(j).tail(n - j).cwiseAbs().maxCoeff(&pivot);
    if (!(largest > tiny)) return false;
    pivot += j;
    pivots[static_cast<std::size_t>(j)] = static_cast<int>(pivot);
    if (pivot != j) A.row(j).segment(k, nk).swap(A.row(pivot).segment(k, nk));
    const Eigen::Index below = n - j - 1;
    if (below == 0) break;
    A.col(j).tail(below) /= A(j, j);
    for (Eigen::Index i = j + 1; i < k + nk; ++i) A.col(i).tail(below) -= A(j, i) * A.col(j).tail(below);
  }
  return true;
}

void swap_rows(Eigen::Ref<MatX> Y, std::span<const int> pivots, Eigen::Index first, Eigen::Index last) {
  for (Eigen::Index j = first; j < last; ++j) {
    const Eigen::Index pivot = pivots[static_cast<std::size_t>(j)];
    if (pivot != j) Y.row(j).swap(Y.row(pivot));
  }
}

}  // namespace

bool factorise_lu(Eigen::Ref<MatX> A, std::span<int> pivots) {
  const Eigen::Index n = A.rows();
  const double tiny = n > 0 ? kSingular * A.cwiseAbs().maxCoeff() : 0.0;
  for (Eigen::Index k = 0; k < n; k += kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    const Eigen::Index end = k + nk;
    if (!factorise_panel(A, k, nk, tiny, pivots)) return false;
    swap_rows(A.leftCols(k), pivots, k, end);
    swap_rows(A.rightCols(n - end), pivots, k, end);
    const auto diagonal = A.block(k, k, nk, nk);
    for (Eigen::Index j = end; j < n; j += kTile) {
      const Eigen::Index nj = std::min(kTile, n - j);
      auto tile = A.block(k, j, nk, nj);
      diagonal.triangularView<Eigen::UnitLower>().solveInPlace(tile);
    }
    subtract_product(A.bottomRightCorner(n - end, n - end), A.block(end, k, n - end, nk), A.block(k, end, nk, n - end));
  }
  return A.allFinite();
}

void solve_lu(const Eigen::Ref<const MatX>& LU, std::span<const int> pivots, Eigen::Ref<MatX> Y) {
  const Eigen::Index n = LU.rows();
  swap_rows(Y, pivots, 0, n);
  for (Eigen::Index c = 0; c < Y.cols(); ++c) {
    auto y = Y.col(c);
    LU.triangularView<Eigen::UnitLower>().solveInPlace(y);
    LU.triangularView<Eigen::Upper>().solveInPlace(y);
  }
}

}  // namespace stylet::dense
