// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dense_lu.hpp"

#include "core/dense_cholesky.hpp"
#include "core/dense_kernels.hpp"

#include <algorithm>

namespace stylet::dense {

namespace {

constexpr double kSingular = 1e-14;

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
    if (!factorise_lu_panel(A, k, nk, tiny, pivots)) return false;
    swap_rows(A.leftCols(k), pivots, k, end);
    swap_rows(A.rightCols(n - end), pivots, k, end);
    solve_lower_tile(A.block(k, k, nk, nk), A.block(k, end, nk, n - end));
    subtract_product(A.bottomRightCorner(n - end, n - end), A.block(end, k, n - end, nk), A.block(k, end, nk, n - end));
  }
  return A.allFinite();
}

void solve_lu(const Eigen::Ref<const MatX>& LU, std::span<const int> pivots, Eigen::Ref<MatX> Y) {
  const Eigen::Index n = LU.rows();
  swap_rows(Y, pivots, 0, n);
  for (Eigen::Index k = 0; k < n; k += kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    auto tile = Y.middleRows(k, nk);
    subtract_product(tile, LU.block(k, 0, nk, k), Y.topRows(k));
    solve_lower_tile(LU.block(k, k, nk, nk), tile);
  }
  for (Eigen::Index k = (n - 1) / kTile * kTile; k >= 0; k -= kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    const Eigen::Index after = k + nk;
    auto tile = Y.middleRows(k, nk);
    subtract_product(tile, LU.block(k, after, nk, n - after), Y.bottomRows(n - after));
    solve_upper_tile(LU.block(k, k, nk, nk), tile);
  }
}

}  // namespace stylet::dense
