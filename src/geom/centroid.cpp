// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/centroid.hpp"

#include <algorithm>

namespace stylet {

Vec3 centroid(const TetMesh& mesh, const std::vector<int>& regions) {
  Vec3 sum = Vec3::Zero();
  double volume = 0.0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const int region = mesh.tet_region[static_cast<std::size_t>(t)];
    if (!regions.empty() && std::find(regions.begin(), regions.end(), region) == regions.end()) continue;
    const double v = tet_volume(mesh, t);
    Vec3 centre = Vec3::Zero();
    for (const Index node : mesh.tets[static_cast<std::size_t>(t)])
      centre += 0.25 * mesh.nodes[static_cast<std::size_t>(node)];
    sum += v * centre;
    volume += v;
  }
  return volume > 0.0 ? Vec3(sum / volume) : Vec3(Vec3::Zero());
}

}  // namespace stylet
