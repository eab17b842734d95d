// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/dense_cholesky.hpp"

#include <algorithm>

/// Products of dense matrices cut into tiles so small that Eigen keeps its work space on the stack at any size: nothing
/// here allocates.
namespace stylet::dense {

/// C ← C − A B
inline void subtract_product(Eigen::Ref<MatX> C, const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& B) {
  constexpr Eigen::Index tile = 2 * kTile;
  for (Eigen::Index j = 0; j < C.cols(); j += tile) {
    const Eigen::Index nj = std::min(tile, C.cols() - j);
    for (Eigen::Index k = 0; k < A.cols(); k += tile) {
      const Eigen::Index nk = std::min(tile, A.cols() - k);
      for (Eigen::Index i = 0; i < C.rows(); i += tile) {
        const Eigen::Index ni = std::min(tile, C.rows() - i);
        C.block(i, j, ni, nj).noalias() -= A.block(i, k, ni, nk) * B.block(k, j, nk, nj);
      }
    }
  }
}

}  // namespace stylet::dense
