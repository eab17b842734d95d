// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/patch.hpp"

#include <algorithm>

namespace stylet {

PatchStiffness patch_stiffness(const Tissue& tissue, std::span<const Index> tets, const Material& material) {
  PatchStiffness patch;
  for (const Index t : tets) {
    const auto nodes = tissue.nodes_of(t);
    patch.nodes.insert(patch.nodes.end(), nodes.begin(), nodes.end());
  }
  std::sort(patch.nodes.begin(), patch.nodes.end());
  patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
  const auto row_of = [&](Index node) {
    return 3 * (std::lower_bound(patch.nodes.begin(), patch.nodes.end(), node) - patch.nodes.begin());
  };

  const auto size = 3 * static_cast<Eigen::Index>(patch.nodes.size());
  patch.K = MatX::Zero(size, size);
  for (const Index t : tets) {
    const auto gradients = barycentric_gradients(tissue.mesh(), t);
    const double volume = tet_volume(tissue.mesh(), t);
    const auto& tet = tissue.mesh().tets[t];
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        patch.K.block<3, 3>(row_of(tet[a]), row_of(tet[b])) += element_block(gradients, volume, material, a, b);
      }
    }
  }
  return patch;
}

}  // namespace stylet
