// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>

namespace stylet {

/// Largest number of displacement nodes of an element: corners and edge middles of a quadratic tetrahedron.
inline constexpr int kMostElementNodes = 10;

/// Interpolation at a material point X from the displacement nodes of its element: u(X) = Σ_i weight_i u(node_i).
struct Shape {
  int count = 0;                                   ///< number of entries in use
  std::array<Index, kMostElementNodes> node{};     ///< displacement nodes (Tissue::node_position)
  std::array<double, kMostElementNodes> weight{};  ///< sum 1; weights of a quadratic element may be negative
};

/// Gradients of the interpolation in Shape: ∂u/∂X = Σ_i u(node_i) gradient_iᵀ.
struct ShapeGradients {
  int count = 0;
  std::array<Index, kMostElementNodes> node{};
  Eigen::Matrix<double, 3, kMostElementNodes> gradient =
      Eigen::Matrix<double, 3, kMostElementNodes>::Zero();  ///< [1/mm] columns, with respect to X
};

}  // namespace stylet
