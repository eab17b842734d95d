// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/dense_cholesky.hpp"
#include "core/dense_kernels.hpp"
#include "stylet/core/types.hpp"

#include <algorithm>
#include <cassert>

namespace stylet {

/// What the needle's tangent H = L Lᵀ means for its load points, from Y = L⁻¹ Jᵀ and z = L⁻¹ g: compliance = Yᵀ Y
/// [mm/N] (3w × 3w) and free = -Yᵀ z [mm] (3w).
/// @param start start(a, b): row of Y before which the columns of loads a … b - 1 are zero
template <class Start>
void condense_columns(const MatX& Y, const VecX& z, Eigen::Index loads, const Start& start,
                      Eigen::Ref<MatX>& compliance, Eigen::Ref<VecX>& free) {
  assert(compliance.rows() == 3 * loads && compliance.cols() == 3 * loads && free.size() == 3 * loads);
  constexpr Eigen::Index stride = dense::kTile / 3;
  for (Eigen::Index a = 0; a < loads; a += stride) {
    const Eigen::Index na = std::min(stride, loads - a);
    const Eigen::Index start_a = start(a, a + na);
    const auto columns = Y.middleCols(3 * a, 3 * na);
    auto motion = free.segment(3 * a, 3 * na);
    motion.noalias() = columns.transpose() * z;
    motion = -motion;
    for (Eigen::Index b = 0; b <= a; b += stride) {
      const Eigen::Index nb = std::min(stride, loads - b);
      constexpr Eigen::Index four = 4;  // numbers are multiplied side by side
      const Eigen::Index reach = Y.rows() - std::max(start_a, start(b, b + nb));
      const Eigen::Index depth = std::min(Y.rows(), (reach + four - 1) / four * four);
      auto tile = compliance.block(3 * a, 3 * b, 3 * na, 3 * nb);
      dense::transposed_product(tile, columns.bottomRows(depth), Y.middleCols(3 * b, 3 * nb).bottomRows(depth));
      if (a == b) {
        tile.template triangularView<Eigen::StrictlyUpper>() = tile.transpose();
      } else {
        compliance.block(3 * b, 3 * a, 3 * nb, 3 * na) = tile.transpose();
      }
    }
  }
}

}  // namespace stylet
