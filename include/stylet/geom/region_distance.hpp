// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <optional>
#include <span>

namespace stylet {

/// Length of the part of a straight path that lies in some regions of a mesh.
/// @param regions numbers of regions of the mesh; may be empty
/// @param from start of the path [mm] LPS
/// @param to end of the path [mm] LPS, different from `from`
/// @return length [mm]; a path along the surface of a region counts as inside it, a path that only touches it in a
///   point does not
double length_in_regions(const TetMesh& mesh, std::span<const int> regions, const Vec3& from, const Vec3& to);

/// Shortest distance between a straight path and some regions of a mesh.
/// @param regions numbers of regions of the mesh
/// @param from start of the path [mm] LPS
/// @param to end of the path [mm] LPS, different from `from`
/// @return distance [mm], 0 where the path passes through the regions; empty where the mesh has no element in them
std::optional<double> distance_to_regions(const TetMesh& mesh, std::span<const int> regions, const Vec3& from,
                                          const Vec3& to);

}  // namespace stylet
