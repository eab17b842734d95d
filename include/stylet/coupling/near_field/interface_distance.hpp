// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/surface_distance.hpp"
#include "stylet/fem/tissue.hpp"
#include "stylet/geom/topology.hpp"

#include <array>
#include <vector>

namespace stylet {

/// The nearest interface between a region and tissue of another modulus, as a plane.
struct NearInterface {
  double depth = std::numeric_limits<double>::infinity();  ///< [mm] distance of the place from the interface
  Vec3 inwards = Vec3::UnitZ();                            ///< unit normal, into the region
  double log_beyond = 0.0;                                 ///< logarithm of Young's modulus [MPa] on the other side
  int beyond = -1;                                         ///< number of the region on the other side
};

/// The nearest interface, and the nearest interface that faces it (SurfaceDistance::opposite()). A missing interface
/// has beyond = −1.
using NearInterfaces = std::array<NearInterface, 2>;

/// Distances to the interfaces between the deformable regions of a mesh, for each region. A face that two regions share
/// is an interface of both. Held regions have no interfaces, because the mesh itself represents their effect on the
/// tissue.
class InterfaceDistance {
 public:
  /// @param tissue its mesh must outlive this object
  InterfaceDistance(const Tissue& tissue, const Topology& topology);

  /// @param x [mm] a place in the region or on its border
  [[nodiscard]] NearInterfaces nearest(int region, const Vec3& x) const;

 private:
  std::vector<SurfaceDistance> of_region_;  ///< (regions) each with the logarithm of the modulus on the other side
  std::vector<std::vector<int>> beyond_;    ///< (regions)(triangles of the region) region on the other side
};

}  // namespace stylet
