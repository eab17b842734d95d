// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dense_cholesky.hpp"

#include "core/dense_kernels.hpp"

#include <algorithm>
#include <cassert>

namespace stylet::dense {

namespace {

/// Factorises the columns first … columns − 1; the columns before them already contain L. The rest gets the Schur
/// complement.
bool factorise_columns(Eigen::Ref<MatX>& A, Eigen::Index first, Eigen::Index columns) {
  const Eigen::Index n = A.rows();
  for (Eigen::Index k = first; k < n;) {
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
    if (!beyond) {
      divide_by_transposed_tile(diagonal, rest);
      invert_tile(diagonal);
    }
    k += nk;
  }
  return A.diagonal().allFinite();
}

}  // namespace

// NOLINTBEGIN(performance-unnecessary-value-param): A is written through the view

bool factorise_first(Eigen::Ref<MatX> A, Eigen::Index columns) { return factorise_columns(A, 0, columns); }

bool factorise(Eigen::Ref<MatX> A) { return factorise_columns(A, 0, A.rows()); }

bool factorise_from(Eigen::Ref<MatX> A, Eigen::Index first) {
  assert(first % kTile == 0);
  return factorise_columns(A, first, A.rows());
}

// NOLINTEND(performance-unnecessary-value-param)

void solve_lower(const Eigen::Ref<const MatX>& L, Eigen::Index start, Eigen::Ref<MatX> Y) {
  const Eigen::Index n = L.rows();
  const Eigen::Index first = start / kTile * kTile;  // the tiles begin where the factor's tiles begin
  for (Eigen::Index k = first; k < n; k += kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    auto tile = Y.middleRows(k, nk);
    subtract_product(tile, L.block(k, first, nk, k - first), Y.middleRows(first, k - first));
    solve_inverted_tile(L.block(k, k, nk, nk), tile);
  }
}

void solve_upper(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> Y) {
  const Eigen::Index n = L.rows();
  for (Eigen::Index k = (n - 1) / kTile * kTile; k >= 0; k -= kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    const Eigen::Index below = n - k - nk;
    auto tile = Y.middleRows(k, nk);
    constexpr int kColumns = 6;
    for (Eigen::Index c = 0; c < Y.cols() && below > 0; c += kColumns) {
      const Eigen::Index count = std::min<Eigen::Index>(kColumns, Y.cols() - c);
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kTile, kColumns> known(nk, count);
      transposed_product(known, L.block(k + nk, k, below, nk), Y.block(k + nk, c, below, count));
      tile.middleCols(c, count) -= known;
    }
    solve_inverted_tile_transposed(L.block(k, k, nk, nk), tile);
  }
}

}  // namespace stylet::dense
