// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <optional>
#include <span>

namespace stylet {

/// How much of a straight way lies in some regions of a mesh.
/// @param regions numbers of regions of the mesh; may be empty
/// @param from start of the way [mm] LPS @param to its end [mm] LPS, not the start
/// @return length [mm]; a way along the regions' surface lies in them, one that touches them in a point does not
double length_in_regions(const TetMesh& mesh, std::span<const int> regions, const Vec3& from, const Vec3& to);

/// The shortest distance between a straight way and some regions of a mesh.
/// @param regions numbers of regions of the mesh
/// @param from start of the way [mm] LPS @param to its end [mm] LPS, not the start
/// @return distance [mm], 0 where the way goes through the regions; empty where the mesh has no element of them
std::optional<double> distance_to_regions(const TetMesh& mesh, std::span<const int> regions, const Vec3& from,
                                          const Vec3& to);

}  // namespace stylet
