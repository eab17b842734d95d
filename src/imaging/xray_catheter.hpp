// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"
#include "stylet/imaging/xray_geometry.hpp"

#include <span>
#include <vector>

namespace stylet {

/// A balloon catheter in the urethra, filled with contrast. It follows the deformed urethra; below the mesh's urethra
/// it continues in an arc to anterior, as the bulbar urethra does, and its balloon lies in the bladder at the urethra's
/// upper end.
class XrayCatheter {
 public:
  /// A mesh without a urethra has no catheter, a mesh without a bladder no balloon. @param mesh is not kept
  XrayCatheter(const TetMesh& mesh, const FluoroscopySettings& settings);

  /// Adds its attenuation along the rays of a picture, as XraySurfaces::add() does. Does not allocate.
  void add(const XrayGeometry& unit, const Eigen::Matrix3Xf& displacement, std::span<float> sums);

 private:
  /// A node's share of a point of the centreline.
  struct Share {
    std::size_t point;
    Index node;
    float weight;
  };

  bool balloon_ = false;
  double contrast_per_mm_ = 0.0;  ///< attenuation that the contrast adds to tissue [1/mm]
  double balloon_per_mm_ = 0.0;   ///< attenuation that it adds to the bladder's filling [1/mm]
  std::size_t arc_points_ = 0;
  double end_mm_ = 0.0;           ///< distance of the uppermost point to the urethra's upper end
  std::vector<Vec3> at_rest_;     ///< [mm] LPS of the points in the urethra, from inferior to superior
  std::vector<Share> shares_;     ///< of the displacement of these points
  std::vector<Vec3> centreline_;  ///< [mm] LPS, in the picture that is being made: the arc, then the urethra
};

}  // namespace stylet
