// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <functional>

namespace stylet {

/// Mesh of a box, the standard body of the tests. The box consists of equal hexahedral cells; each cell is cut into six
/// tetrahedra around the diagonal from its lowest to its highest corner (Kuhn's subdivision), so the mesh conforms. It
/// has one region, "body".
///
/// Node (i, j, k) of the grid has the number i + (cells[0]+1) · (j + (cells[1]+1) · k). Cell (i, j, k) consists of the
/// six tetrahedra that start at number 6 · (i + cells[0] · (j + cells[1] · k)).
/// @param lo [mm] lowest corner
/// @param hi [mm] highest corner, above `lo` in each coordinate
/// @param cells number of cells along x, y, z, each ≥ 1
/// @param jitter moves each inner node by up to ± jitter × cell size along each axis, in the same way on every run;
///   outer nodes keep their places. Clamped to 0 … 0.15, which keeps the volume of every tetrahedron positive.
/// @cite Kuhn1960
TetMesh box_mesh(const Vec3& lo, const Vec3& hi, std::array<int, 3> cells, double jitter = 0.0);

/// Assigns each tetrahedron of a mesh to a region by the position of its centroid.
/// @param regions names of the regions
/// @param region_at returns the number of the region, 0 … regions − 1, for a centroid [mm] LPS
void assign_regions(TetMesh& mesh, std::vector<std::string> regions, const std::function<int(const Vec3&)>& region_at);

}  // namespace stylet
