// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/patch.hpp"

#include "discretisation.hpp"

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
  std::vector<Eigen::Index> rows;
  tissue.discretisation().stiffness(
      tets, [&](Index /*tet*/) { return material; },
      [&](std::span<const Index> nodes, const MatX& part) {
        rows.resize(nodes.size());
        std::transform(nodes.begin(), nodes.end(), rows.begin(), row_of);
        for (std::size_t a = 0; a < nodes.size(); ++a) {
          for (std::size_t b = 0; b <= a; ++b) {
            const Mat3 block = part.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b));
            patch.K.block<3, 3>(rows[a], rows[b]) += block;
            if (b < a) patch.K.block<3, 3>(rows[b], rows[a]) += block.transpose();
          }
        }
      });
  return patch;
}

}  // namespace stylet
