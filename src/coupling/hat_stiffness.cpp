// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/hat_stiffness.hpp"

namespace stylet {

HatStiffness hat_stiffness(const SplitMesh& mesh, const SplitMesh::Part& part, const Material& material) {
  HatStiffness stiffness;
  stiffness.border.fill(Mat3::Zero());
  const auto g = mesh.gradients(part.leaf);
  const double volume = mesh.volume(part.leaf);
  // The child that replaces vertex q has volume V l_q and hat gradient g_q / l_q.
  for (int q = 0; q < 4; ++q) {
    if (q == part.opposite) continue;
    const Vec3 gq = g.col(q);
    stiffness.own += (volume / part.weights[q]) * ((material.lambda() + material.mu()) * gq * gq.transpose() +
                                                   material.mu() * gq.squaredNorm() * Mat3::Identity());
  }
  if (part.opposite < 0) return stiffness;
  // Σ over the children of volume × hat gradient = V Σ_{q ≠ o} g_q = −V g_o, so the border is −K_jo of the whole
  // element.
  for (int j = 0; j < 4; ++j)
    stiffness.border[static_cast<std::size_t>(j)] = -element_block(g, volume, material, j, part.opposite);
  return stiffness;
}

}  // namespace stylet
