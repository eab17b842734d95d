// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <vector>

namespace stylet {

/// Centroid of a set of regions by volume [mm] LPS; the whole mesh when the set is empty.
Vec3 centroid(const TetMesh& mesh, const std::vector<int>& regions);

}  // namespace stylet
