// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/topology.hpp"

#include <span>
#include <vector>

namespace stylet {

/// How a displacement changes the size of the gland. Components of vectors are left-right, anterior-posterior and
/// superior-inferior, the axes of LPS.
struct GlandForm {
  Vec3 extent_mm = Vec3::Zero();       ///< undeformed, between the outermost points of the gland's surface
  Vec3 change_percent = Vec3::Zero();  ///< of the extents, relative to the undeformed ones
  double volume_percent = 0.0;         ///< mean of div u over the gland's volume
  Vec3 shift_mm = Vec3::Zero();        ///< mean displacement of the gland's volume
};

/// Measures the gland as a ruler on a picture does: the distance between its outermost points along each axis.
class GlandMeasure {
 public:
  /// @param regions numbers of the regions that form the gland, which have at least one element
  GlandMeasure(const TetMesh& mesh, const Topology& topology, std::span<const int> regions);

  /// @param u [mm] LPS (3 × nodes of the mesh)
  [[nodiscard]] GlandForm form(const Eigen::Ref<const Eigen::Matrix3Xf>& u) const;
  /// Nodes on the surface of the gland.
  [[nodiscard]] const std::vector<Index>& surface() const { return surface_; }

 private:
  const TetMesh* mesh_;
  std::vector<Index> surface_;
  std::vector<Index> tets_;
};

}  // namespace stylet
