// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/geom/surface.hpp"

#include <array>
#include <string>
#include <vector>

namespace stylet {

/// A conforming tetrahedral mesh of several regions.
struct TetMesh {
  std::vector<Vec3> nodes;                 ///< (n) positions [mm] LPS
  std::vector<std::array<Index, 4>> tets;  ///< (m) node numbers; the volume is positive: det(x1-x0, x2-x0, x3-x0) > 0
  std::vector<int> tet_region;             ///< (m) index in `regions`
  std::vector<std::string> regions;        ///< names of the regions, e.g. "prostate", "body"
  /// (regions) The structures as they were given, for pictures: closed, with normals outwards, whatever the size of the
  /// elements. Where two overlap, the region that comes first in `regions` is meant. Empty: pictures show the faces of
  /// the elements.
  std::vector<Surface> surfaces;

  [[nodiscard]] Index node_count() const { return static_cast<Index>(nodes.size()); }
  [[nodiscard]] Index tet_count() const { return static_cast<Index>(tets.size()); }

  /// Index of the region called `name` (exact match), or -1.
  [[nodiscard]] int region_index(std::string_view name) const;
};

/// Signed volume of tetrahedron t [mm³].
double tet_volume(const TetMesh& mesh, Index t);

/// Gradients of the four barycentric coordinates of tetrahedron t [1/mm] (3×4, one column each).
Eigen::Matrix<double, 3, 4> barycentric_gradients(const TetMesh& mesh, Index t);

/// Refuses a mesh that cannot be simulated: an empty mesh, coordinates that are NaN or infinite, node or region numbers
/// out of range, inverted or flat tetrahedra, duplicate tetrahedra, a face shared by more than two tetrahedra or by two
/// on the same side of it, a tetrahedron that names a node twice, unreferenced nodes, and an extent below 5 mm or above
/// 2 m, which indicates wrong units.
/// @param where name of the mesh in the error, such as a file name
Result<> check_mesh(const TetMesh& mesh, const std::string& where);

}  // namespace stylet
