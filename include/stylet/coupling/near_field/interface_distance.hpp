// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/surface_distance.hpp"
#include "stylet/fem/tissue.hpp"
#include "stylet/geom/topology.hpp"

#include <array>
#include <vector>

namespace stylet {

/// The nearest interface of a region to tissue of another modulus, as a plane.
struct NearInterface {
  double depth = std::numeric_limits<double>::infinity();  ///< [mm] of a place in the region behind it
  Vec3 inwards = Vec3::UnitZ();                            ///< unit normal, into the region
  double log_beyond = 0.0;                                 ///< logarithm of Young's modulus [MPa] on the other side
  int beyond = -1;                                         ///< region there
};

/// The nearest interface, and the nearest that faces it (SurfaceDistance::opposite()); beyond < 0: there is none.
using NearInterfaces = std::array<NearInterface, 2>;

/// Distances to the interfaces between the regions of a mesh that give way, by region: a face that two regions share is
/// an interface of both. Held regions have none; what they do to the tissue the mesh knows.
class InterfaceDistance {
 public:
  /// @param tissue its mesh must stay
  InterfaceDistance(const Tissue& tissue, const Topology& topology);

  /// @param x [mm] in the region or on its border
  [[nodiscard]] NearInterfaces nearest(int region, const Vec3& x) const;

 private:
  std::vector<SurfaceDistance> of_region_;  ///< with the logarithm of the modulus beyond
  std::vector<std::vector<int>> beyond_;    ///< (regions)(triangles of each) region on the other side
};

}  // namespace stylet
