// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/beam_shape.hpp"

namespace stylet::beam {

/// Sums over the loads beyond an element, with respect to the base, in base axes: Σ f and Σ r fᵀ.
struct Resultant {
  Vec3 force = Vec3::Zero();   ///< Σ f [N]
  Mat3 tensor = Mat3::Zero();  ///< Σ r fᵀ [N mm]

  void add(const Pull& pull) {
    force += pull.force;
    tensor.noalias() += pull.point * pull.force.transpose();
  }
  /// Σ r × f [N mm]
  [[nodiscard]] Vec3 moment() const {
    return {tensor(1, 2) - tensor(2, 1), tensor(2, 0) - tensor(0, 2), tensor(0, 1) - tensor(1, 0)};
  }
  /// Σ [f]×[r]× = Σ r fᵀ - (r·f) I [N mm]
  [[nodiscard]] Mat3 double_cross() const {
    Mat3 m = tensor;
    m.diagonal().array() -= tensor.trace();
    return m;
  }
};

}  // namespace stylet::beam
