// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <array>
#include <string>
#include <vector>

namespace stylet {

/// A conforming multi-region tetrahedral mesh.
struct TetMesh {
  std::vector<Vec3> nodes;                 ///< [mm] LPS (n)
  std::vector<std::array<Index, 4>> tets;  ///< node numbers (m), positive volume: det(x1-x0, x2-x0, x3-x0) > 0
  std::vector<int> tet_region;             ///< (m) index into `regions`
  std::vector<std::string> regions;        ///< region names, e.g. "prostate", "body"

  [[nodiscard]] Index node_count() const { return static_cast<Index>(nodes.size()); }
  [[nodiscard]] Index tet_count() const { return static_cast<Index>(tets.size()); }

  /// Index of the region called `name` (exact match), or -1.
  [[nodiscard]] int region_index(std::string_view name) const;
};

/// Volume of tetrahedron t [mm³], signed.
double tet_volume(const TetMesh& mesh, Index t);

/// Gradients of the four barycentric coordinates of tetrahedron t [1/mm], columns (3×4).
Eigen::Matrix<double, 3, 4> barycentric_gradients(const TetMesh& mesh, Index t);

/// Refuses a mesh that no simulation may use: empty, NaN or infinite coordinates, node numbers out of range, inverted
/// or flat tetrahedra, duplicate tetrahedra, a face shared by more than two tetrahedra or by two on the same side of
/// it, a node named twice by a tetrahedron, unreferenced nodes, bad region numbers, coordinates whose extent (< 5 mm or
/// > 2 m) betrays wrong units.
/// @param where what to call the mesh in the message (a file name)
Result<> check_mesh(const TetMesh& mesh, const std::string& where);

}  // namespace stylet
