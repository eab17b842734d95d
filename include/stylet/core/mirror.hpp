// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <algorithm>

namespace stylet {

/// Copies the lower triangle of a square matrix into the upper one. Works in tiles that fit into the processor's cache.
inline void mirror_lower(MatX& A) {
  constexpr Eigen::Index tile = 64;
  const Eigen::Index n = A.rows();
  for (Eigen::Index column = 0; column < n; column += tile) {
    const Eigen::Index width = std::min(tile, n - column);
    for (Eigen::Index j = column; j < column + width; ++j) {
      for (Eigen::Index i = j + 1; i < column + width; ++i) A(j, i) = A(i, j);
    }
    for (Eigen::Index row = column + width; row < n; row += tile) {
      const Eigen::Index height = std::min(tile, n - row);
      A.block(column, row, width, height) = A.block(row, column, height, width).transpose();
    }
  }
}

}  // namespace stylet
