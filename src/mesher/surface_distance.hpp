// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <vector>

namespace stylet::meshing {

/// Statistics of distances [mm].
struct DistanceSummary {
  double sum = 0;
  double max = 0;
  std::size_t count = 0;
};

/// Distance [mm] between each point and the nearest face on the boundary of a region.
DistanceSummary distance_to_boundary(const TetMesh& mesh, int region, const std::vector<Vec3>& points);

}  // namespace stylet::meshing
