// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/geom/contours.hpp"

#include <vector>

namespace stylet {

/// Points that stand for the volume of a structure.
struct StructureSamples {
  std::vector<Vec3> points;        ///< [mm] LPS
  std::vector<double> volume_mm3;  ///< volume that each point stands for
  [[nodiscard]] double volume_cc() const;
};

/// Samples a structure given by contours on parallel planes. Each plane stands for a slab that reaches half-way to its
/// neighbours; the first and the last slab are as thick on their outer side as on their inner one, and so is a slab
/// beside a gap of more than 2.5 times the usual distance of the planes. Within a plane a point is inside if an odd
/// number of contours surround it, so that a contour within another one is a hole.
/// @param roi contours on at least two planes, checked before (check_roi())
/// @param step_mm [mm] > 0, largest distance of neighbouring samples
/// Errors: a structure without two planes, a step that is not above 0, more than 100 million samples.
Result<StructureSamples> sample_structure(const Roi& roi, double step_mm);

}  // namespace stylet
