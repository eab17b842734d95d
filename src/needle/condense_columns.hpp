// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/dense_cholesky.hpp"
#include "core/dense_kernels.hpp"
#include "stylet/core/types.hpp"

#include <algorithm>
#include <cassert>

/// Compliance of the load points from the needle's tangent H = L Lᵀ, with Y = L⁻¹ Jᵀ and z = L⁻¹ g. start(a, b) is the
/// row of Y before which the columns of the loads a … b − 1 are zero.
namespace stylet {

/// Number of loads whose columns are processed together.
inline constexpr Eigen::Index kCondensed = dense::kTile / 3;

/// Compliance Yᵀ Y [mm/N] (3w × 3w): the rows and columns of the loads first … last − 1, for these loads and the loads
/// before them. @param first a multiple of kCondensed
template <class Start>
void condense_columns(const MatX& Y, Eigen::Index first, Eigen::Index last, const Start& start,
                      Eigen::Ref<MatX>& compliance) {
  assert(first % kCondensed == 0 && compliance.rows() >= 3 * last && compliance.cols() >= 3 * last);
  for (Eigen::Index a = first; a < last; a += kCondensed) {
    const Eigen::Index na = std::min(kCondensed, last - a);
    const Eigen::Index start_a = start(a, a + na);
    const auto columns = Y.middleCols(3 * a, 3 * na);
    for (Eigen::Index b = 0; b <= a; b += kCondensed) {
      const Eigen::Index nb = std::min(kCondensed, last - b);
      constexpr Eigen::Index four = 4;  // four numbers are multiplied side by side
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

/// Motion of the load points in the Newton step, −Yᵀ z [mm] (3w).
template <class Start>
void condense_gradient(const MatX& Y, const VecX& z, Eigen::Index loads, const Start& start, Eigen::Ref<VecX>& free) {
  assert(free.size() == 3 * loads);
  for (Eigen::Index c = 0; c < loads; c += kCondensed) {
    const Eigen::Index count = std::min(kCondensed, loads - c);
    const Eigen::Index reach = Y.rows() - start(c, c + count);
    dense::transposed_product(free.segment(3 * c, 3 * count), Y.block(Y.rows() - reach, 3 * c, reach, 3 * count),
                              z.tail(reach));
  }
  free = -free;
}

}  // namespace stylet
