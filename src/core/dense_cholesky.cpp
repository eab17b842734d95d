// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dense_cholesky.hpp"

#include "core/dense_kernels.hpp"

#include <algorithm>

namespace stylet::dense {

bool factorise_first(Eigen::Ref<MatX> A, Eigen::Index columns) {
  const Eigen::Index n = A.rows();
  for (Eigen::Index k = 0; k < n;) {
    const bool beyond = k >= columns;
    const Eigen::Index nk = std::min(kTile, beyond ? n - k : columns - k);
    const Eigen::Index below = n - k - nk;
    const Eigen::Index before = std::min(k, columns);
    const auto done = A.block(k, 0, nk, before);
    auto diagonal = A.block(k, k, nk, nk);
    auto rest = A.block(k + nk, k, below, nk);
    subtract_product_transposed(diagonal, done, done);
    if (!beyond && !factorise_tile(diagonal)) return false;
    subtract_product_transposed(rest, A.block(k + nk, 0, below, before), done);
    if (!beyond) divide_by_transposed_tile(diagonal, rest);
    k += nk;
  }
  return A.diagonal().allFinite();
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): A is written through the view
bool factorise(Eigen::Ref<MatX> A) { return factorise_first(A, A.rows()); }

void solve_lower(const Eigen::Ref<const MatX>& L, Eigen::Index start, Eigen::Ref<MatX> Y) {
  const Eigen::Index n = L.rows();
  for (Eigen::Index k = start; k < n; k += kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    auto tile = Y.middleRows(k, nk);
    subtract_product(tile, L.block(k, start, nk, k - start), Y.middleRows(start, k - start));
    solve_lower_tile(L.block(k, k, nk, nk), false, tile);
  }
}

void solve_upper(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> Y) {
  const Eigen::Index n = L.rows();
  for (Eigen::Index k = (n - 1) / kTile * kTile; k >= 0; k -= kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    const Eigen::Index below = n - k - nk;
    auto tile = Y.middleRows(k, nk);
    for (Eigen::Index c = 0; c < Y.cols(); ++c) {
      Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kTile, 1> known(nk);
      transposed_product(known, L.block(k + nk, k, below, nk), Y.col(c).tail(below));
      tile.col(c) -= known;
    }
    solve_lower_transposed_tile(L.block(k, k, nk, nk), tile);
  }
}

}  // namespace stylet::dense
