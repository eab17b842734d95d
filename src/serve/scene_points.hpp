// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/fine_surface.hpp"

namespace stylet::serve {

/// The points of a scene: nodes of the mesh, then points between these where the surfaces are drawn finer.
struct ScenePoints {
  std::vector<Index> nodes;         ///< of the mesh
  std::vector<SurfacePoint> fines;  ///< between numbers in `nodes`

  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(nodes.size() + fines.size()); }
  /// All points, between nodes of the mesh.
  [[nodiscard]] std::vector<SurfacePoint> on_mesh() const;
  /// Moves the finer points along with the nodes they lie between. @param u [mm] (3 × points), there for the nodes
  void carry_along(Eigen::Ref<Eigen::Matrix3Xf> u) const;
};

}  // namespace stylet::serve
