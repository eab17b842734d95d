// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy.hpp"

namespace stylet::meshing {

/// Wanted element size: `scale` in the target, growing with the distance from it, but small enough to resolve thin
/// structures. Sampled once on a grid, so that evaluation is cheap.
class SizeField {
 public:
  SizeField(const Anatomy& anatomy, MeshPreset preset);

  /// Wanted edge length [mm] at p. @param scale [mm] edge length in the target
  [[nodiscard]] double operator()(const Vec3& p, double scale) const;
  /// Scale [mm] with which the size field gives about `nodes` nodes.
  [[nodiscard]] double scale_for(double nodes) const;

 private:
  GridShape growth_;          ///< size / size in the target
  GridShape limit_;           ///< [mm] largest size that still resolves the structures nearby
  std::vector<bool> inside_;  ///< (grid nodes) whether the node is inside the anatomy
};

}  // namespace stylet::meshing
