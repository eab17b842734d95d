// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <array>
#include <utility>

namespace stylet::test {

/// Makes a block of x ≥ 0, z = 0 … 100 mm its own mirror image in x = 0. It is mirrored upside down as well, so that
/// the surface's triangles along the plane belong to elements with a face in the plane; elements that touch the plane
/// with an edge have a displacement gradient of their own side only.
inline void mirror(TetMesh& mesh) {
  for (Vec3& x : mesh.nodes) x.z() = 100.0 - x.z();
  const std::size_t nodes = mesh.nodes.size();
  std::vector<Index> image(nodes);
  for (std::size_t k = 0; k < nodes; ++k) {
    const Vec3 x = mesh.nodes[k];
    image[k] = static_cast<Index>(k);
    if (x.x() == 0.0) continue;
    image[k] = static_cast<Index>(mesh.nodes.size());
    mesh.nodes.emplace_back(-x.x(), x.y(), x.z());
  }
  const std::size_t tets = mesh.tets.size();
  for (std::size_t t = 0; t < tets; ++t) {
    std::array<Index, 4> tet = mesh.tets[t];
    for (Index& node : tet) node = image[static_cast<std::size_t>(node)];
    std::swap(mesh.tets[t][0], mesh.tets[t][1]);
    mesh.tets.push_back(tet);
    mesh.tet_region.push_back(mesh.tet_region[t]);
  }
}

}  // namespace stylet::test
