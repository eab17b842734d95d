// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <vector>

namespace stylet {

/// Centroid of the volume of some regions [mm] LPS.
/// @param regions numbers of regions of the mesh; empty stands for the whole mesh
/// @return the origin where these regions have no volume
Vec3 centroid(const TetMesh& mesh, const std::vector<int>& regions);

}  // namespace stylet
