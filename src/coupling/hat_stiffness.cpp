// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/hat_stiffness.hpp"

namespace stylet {

Mat3 hat_stiffness(const Eigen::Matrix<double, 3, 4>& gradients, double volume, const Material& material,
                   const Vec4& weights) {
  // The child that replaces vertex q has volume V l_q and hat gradient g_q / l_q.
  Mat3 k = Mat3::Zero();
  double diagonal = 0.0;
  for (int q = 0; q < 4; ++q) {
    if (weights[q] == 0.0) continue;
    const Vec3 g = gradients.col(q);
    k.noalias() += ((material.lambda() + material.mu()) / weights[q]) * g * g.transpose();
    diagonal += material.mu() / weights[q] * g.squaredNorm();
  }
  k.diagonal().array() += diagonal;
  return volume * k;
}

std::array<Mat3, 4> hat_border(const Eigen::Matrix<double, 3, 4>& gradients, double volume, const Material& material,
                               int opposite) {
  // Σ over the children of volume × hat gradient = V Σ_{q ≠ o} g_q = −V g_o, so the border is −K_jo of the whole
  // element.
  std::array<Mat3, 4> border;
  for (int j = 0; j < 4; ++j)
    border[static_cast<std::size_t>(j)] = -element_block(gradients, volume, material, j, opposite);
  return border;
}

}  // namespace stylet
