// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/contours.hpp"

#include <Eigen/Geometry>

namespace stylet::cli {

/// Size of a structure, computed from its contours.
struct RoiMeasures {
  Index slices = 0;
  Index points = 0;
  double slice_spacing_mm = 0;  ///< median distance of neighbouring slices, 0 with fewer than two
  double volume_cc = 0;         ///< sum of area × thickness; contours inside others are holes
  Eigen::AlignedBox3d box;      ///< [mm] LPS
};

RoiMeasures measure(const Roi& roi);

}  // namespace stylet::cli
