// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/kelvinlet.hpp"

namespace stylet::validate {

/// Forces that move a rigid cylinder across and along its axis.
struct CylinderForces {
  double lateral_N = 0.0;
  double axial_N = 0.0;
};

/// Forces that move a rigid cylinder with flat ends, bonded to an unbounded medium, by `way`. Computed by boundary
/// elements: the tractions on its surface are those whose field, made of Kelvin's solution, moves every point of the
/// surface by `way`. (The single layer is sufficient, because the inside of the surface moves rigidly and its double
/// layer is constant.) Tractions vary around the axis as cos θ and sin θ and are constant on each ring of the surface;
/// the displacement is prescribed in the middle of each ring. Only Kelvin's solution is shared with the coupling's
/// kernel.
/// @param length, radius, way [mm]
CylinderForces bonded_cylinder(double length, double radius, double way, const Medium& medium);

/// The same forces by the formulas for slender bodies (docs/theory/near_field.md §2).
CylinderForces slender_cylinder(double length, double radius, double way, const Medium& medium);

}  // namespace stylet::validate
