// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>

namespace stylet {

/// Most displacement nodes an element has: the corners and the middles of the edges of a quadratic tetrahedron.
inline constexpr int kMostElementNodes = 10;

/// How a material point is moved by the displacement nodes of its element: u(X) = Σ_i weight_i u(node_i).
struct Shape {
  int count = 0;                                   ///< of nodes in use
  std::array<Index, kMostElementNodes> node{};     ///< displacement nodes (Tissue::node_position)
  std::array<double, kMostElementNodes> weight{};  ///< sum 1; those of a quadratic element may be negative
};

/// Gradients of the same: ∂u/∂X = Σ_i u(node_i) gradient_iᵀ.
struct ShapeGradients {
  int count = 0;
  std::array<Index, kMostElementNodes> node{};
  Eigen::Matrix<double, 3, kMostElementNodes> gradient =
      Eigen::Matrix<double, 3, kMostElementNodes>::Zero();  ///< [1/mm] columns, with respect to X
};

}  // namespace stylet
