// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <vector>

namespace stylet {

/// A needle in a picture.
struct ShownNeedle {
  std::vector<Vec3> centreline_mm;  ///< LPS, from base to tip, at least two points
  double diameter_mm = 1.27;
  double lumen_diameter_mm = 1.0;  ///< 0 = the needle is solid
};

/// A seed in a picture.
struct ShownSeed {
  Vec3 centre_mm = Vec3::Zero();  ///< LPS, where the seed is now
  Vec3 axis = Vec3::UnitZ();      ///< unit vector
  double length_mm = 4.5;
  double diameter_mm = 0.8;
};

/// The patient at one moment, as pictures show it: a mesh in its undeformed shape, and what has moved since.
struct Moment {
  double time_s = 0.0;
  Eigen::Matrix3Xf displacement;  ///< (3 × nodes of the mesh) [mm] LPS
  std::vector<ShownNeedle> needles;
  std::vector<ShownSeed> seeds;
};

/// The moment at which nothing has moved and no needle is near.
Moment moment_at_rest(const TetMesh& mesh);

}  // namespace stylet
