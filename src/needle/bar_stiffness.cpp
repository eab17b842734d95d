// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/bar_stiffness.hpp"

#include <array>

namespace stylet::tet {

BarStiffness::BarStiffness(const TetShape& shape) : segments_(static_cast<std::size_t>(shape.segments())) {}

void BarStiffness::assemble(const TetShape& shape) {
  if (revision_ == shape.revision()) return;
  for (int k = 0; k < shape.segments(); ++k) assemble_segment(shape, k, segments_[static_cast<std::size_t>(k)]);
  revision_ = shape.revision();
}

/// Adds the tangent blocks of the St. Venant–Kirchhoff law between the nodes a and b of each element, with G = F g:
///   V (λ G_a G_bᵀ + μ G_b G_aᵀ + μ (g_a·g_b) F Fᵀ)  +  V (g_a·S g_b) I.
/// The first term is the material part, which damping increases, the second the geometric part (Bonet & Wood, Nonlinear
/// Continuum Mechanics for Finite Element Analysis, 2008, §9.4).
void BarStiffness::assemble_segment(const TetShape& shape, int segment, SegmentStiffness& K) {
  K.material.setZero();
  K.geometric.setZero();
  const double stiffer = 1.0 + shape.damping();
  for (int e = 0; e < static_cast<int>(shape.mesh().elements.size()); ++e) {
    const Element& element = shape.unloaded(segment, e);
    const Mat3& F = shape.element(segment, e).F;
    const Mat3& S = shape.element(segment, e).S;
    const double lambda = stiffer * element.volume * shape.lambda();
    const double mu = stiffer * element.volume * shape.mu();
    const Mat3 FFt = mu * F * F.transpose();
    std::array<Vec3, 4> G;
    std::array<Vec3, 4> Sg;
    for (int a = 0; a < 4; ++a) {
      G[a] = F * element.gradient[a];
      Sg[a] = element.volume * (S * element.gradient[a]);
    }
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const int i = element.node[a];
        const int j = element.node[b];
        if (j > i) continue;
        K.material.block<3, 3>(3 * i, 3 * j) += lambda * G[a] * G[b].transpose() + mu * G[b] * G[a].transpose() +
                                                element.gradient[a].dot(element.gradient[b]) * FFt;
        K.geometric(i, j) += element.gradient[a].dot(Sg[b]);
      }
    }
  }
}

MatX BarStiffness::whole(const TetShape& shape) const {
  MatX full = MatX::Zero(shape.displacement.size(), shape.displacement.size());
  const int nodes = static_cast<int>(shape.mesh().nodes.size());
  for (int k = 0; k < shape.segments(); ++k) {
    const SegmentStiffness& K = segment(k);
    for (int i = 0; i < nodes; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Eigen::Index row = shape.dof(k, i);
        const Eigen::Index column = shape.dof(k, j);
        if (row < 0 || column < 0) continue;
        const Mat3 block = K.material.block<3, 3>(3 * i, 3 * j) + K.geometric(i, j) * Mat3::Identity();
        full.block<3, 3>(row, column) += block;
        if (i != j) full.block<3, 3>(column, row) += block.transpose();
      }
    }
  }
  return full;
}

}  // namespace stylet::tet
