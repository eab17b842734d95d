// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <functional>

namespace stylet {

/// The standard test body: a box of equal hexahedral cells, each cut into six tetrahedra around the diagonal from its
/// lowest to its highest corner (Kuhn's subdivision), so that the mesh conforms. One region, "body".
///
/// Node (i, j, k) of the grid has number i + (cells[0]+1) · (j + (cells[1]+1) · k); cell (i, j, k) holds the six
/// tetrahedra from 6 · (i + cells[0] · (j + cells[1] · k)).
/// @param lo [mm] lowest corner
/// @param hi [mm] highest corner, above `lo` in each coordinate
/// @param cells cells along x, y, z, each ≥ 1
/// @param jitter moves each node inside the box by up to ± jitter × cell size along each axis, the same way on every
///   run; outer nodes stay. Limited to 0 … 0.15, which keeps every tetrahedron positive.
/// @cite Kuhn1960
TetMesh box_mesh(const Vec3& lo, const Vec3& hi, std::array<int, 3> cells, double jitter = 0.0);

/// Divides a mesh into regions by the place of each tetrahedron's centroid.
/// @param regions names of the regions
/// @param region_at number of the region, 0 … regions − 1, at a centroid [mm]
void assign_regions(TetMesh& mesh, std::vector<std::string> regions, const std::function<int(const Vec3&)>& region_at);

}  // namespace stylet
