// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/fine_surface.hpp"
#include "stylet/geom/tet_mesh.hpp"

namespace stylet::serve {

/// All nodes of a mesh as surface points.
std::vector<SurfacePoint> nodes_as_points(const TetMesh& mesh);

/// The points of a scene: nodes of the mesh, then points between them where surfaces are refined.
struct ScenePoints {
  std::vector<Index> nodes;         ///< node indices of the mesh
  std::vector<SurfacePoint> fines;  ///< their `node` are indices in `nodes`

  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(nodes.size() + fines.size()); }
  /// All points as surface points whose `node` are node indices of the mesh.
  [[nodiscard]] std::vector<SurfacePoint> on_mesh() const;
  /// Interpolates the displacement of the finer points from the nodes around them.
  /// @param u [mm] (3 × points); the columns of the nodes are given, the others are computed
  void carry_along(Eigen::Ref<Eigen::Matrix3Xf> u) const;
};

}  // namespace stylet::serve
