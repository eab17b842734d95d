// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/material.hpp"

namespace stylet::detail {

/// Cauchy stress for a displacement gradient, λ tr(ε) I + 2 μ ε [MPa] (3×3).
inline Mat3 cauchy_stress(const Material& material, const Mat3& gradient) {
  const Mat3 strain = 0.5 * (gradient + gradient.transpose());
  return material.lambda() * strain.trace() * Mat3::Identity() + 2.0 * material.mu() * strain;
}

/// Components xx yy zz xy yz zx of a symmetric tensor (6).
inline Eigen::Matrix<double, 6, 1> six_components(const Mat3& s) {
  return (Eigen::Matrix<double, 6, 1>() << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0)).finished();
}

/// λ a bᵀ + μ b aᵀ + μ (a·b) I: the contribution of shape functions with gradients a and b to the stiffness between
/// their nodes (3×3). Exchanging a and b gives the exact transpose, to the last bit.
inline Mat3 stiffness_block(const Vec3& a, const Vec3& b, double lambda, double mu) {
  Mat3 block;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) block(i, j) = lambda * (a[i] * b[j]) + mu * (b[i] * a[j]);
  }
  block.diagonal().array() += mu * a.dot(b);
  return block;
}

}  // namespace stylet::detail
