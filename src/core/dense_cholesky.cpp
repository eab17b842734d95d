// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dense_cholesky.hpp"

#include <Eigen/Cholesky>

#include <algorithm>

namespace stylet::dense {

bool factorise(Eigen::Ref<MatX> A) {
  const Eigen::Index n = A.rows();
  for (Eigen::Index k = 0; k < n; k += kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    const auto done = A.block(k, 0, nk, k);
    auto diagonal = A.block(k, k, nk, nk);
    if (k > 0) diagonal.noalias() -= done * done.transpose();
    Eigen::LLT<Eigen::Ref<MatX>> llt(diagonal);
    if (llt.info() != Eigen::Success) return false;
    for (Eigen::Index i = k + nk; i < n; i += kTile) {
      const Eigen::Index ni = std::min(kTile, n - i);
      auto tile = A.block(i, k, ni, nk);
      if (k > 0) tile.noalias() -= A.block(i, 0, ni, k) * done.transpose();
      diagonal.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(tile);
    }
  }
  return A.diagonal().allFinite();
}

void solve_lower(const Eigen::Ref<const MatX>& L, Eigen::Index start, Eigen::Ref<MatX> Y) {
  const Eigen::Index n = L.rows();
  for (Eigen::Index k = start; k < n; k += kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    auto tile = Y.middleRows(k, nk);
    if (k > start) tile.noalias() -= L.block(k, start, nk, k - start) * Y.middleRows(start, k - start);
    L.block(k, k, nk, nk).triangularView<Eigen::Lower>().solveInPlace(tile);
  }
}

void solve_upper(const Eigen::Ref<const MatX>& L, Eigen::Ref<MatX> Y) {
  const Eigen::Index n = L.rows();
  if (Y.cols() == 1) {
    auto y = Y.col(0);
    L.triangularView<Eigen::Lower>().transpose().solveInPlace(y);
    return;
  }
  for (Eigen::Index k = (n - 1) / kTile * kTile; k >= 0; k -= kTile) {
    const Eigen::Index nk = std::min(kTile, n - k);
    const Eigen::Index below = n - k - nk;
    auto tile = Y.middleRows(k, nk);
    if (below > 0) tile.noalias() -= L.block(k + nk, k, below, nk).transpose() * Y.bottomRows(below);
    L.block(k, k, nk, nk).triangularView<Eigen::Lower>().transpose().solveInPlace(tile);
  }
}

}  // namespace stylet::dense
