// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"

namespace stylet {

/// A surface whose points move with the tissue. Each is interpolated between the nodes of the element that holds it; a
/// point a little outside of the mesh moves with the element behind the nearest face towards the mesh's middle.
struct TiedSurface {
  int region = -1;
  std::vector<std::array<Index, 4>> nodes;  ///< (points) of the mesh
  std::vector<Vec4> weights;                ///< (points) of these nodes, sum 1
  std::vector<std::array<Index, 3>> triangles;

  /// Positions (points) [mm] LPS at rest, or where the nodes are displaced.
  /// @param displacement [mm] (3 × nodes of the mesh)
  [[nodiscard]] std::vector<Vec3> positions(const TetMesh& mesh, const VecX& displacement) const;
};

/// Ties the surfaces of a mesh (TetMesh::surfaces) to its elements: one for each region, in the order of the regions;
/// empty for a mesh without surfaces of its own.
std::vector<TiedSurface> tie_surfaces(const Locator& locator);

}  // namespace stylet
