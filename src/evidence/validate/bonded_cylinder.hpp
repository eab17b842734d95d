// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/kelvinlet.hpp"

namespace stylet::validate {

/// Forces that move a rigid cylinder.
struct CylinderForces {
  double lateral_N = 0.0;
  double axial_N = 0.0;
};

/// A rigid cylinder with flat ends, bonded to an unbounded medium, by boundary elements: the tractions on its surface
/// whose field, made of Kelvin's solution, moves every point of the surface by `way`. (The single layer is all there
/// is: the inside of the surface moves rigidly, so its double layer is constant.) Tractions vary around the axis as
/// cos θ and sin θ and are constant on each of the rings the surface is divided into; displacements are asked for in
/// the middle of each. Nothing is shared with the kernel of the coupling but Kelvin's solution itself.
/// @param length, radius, way [mm]
CylinderForces bonded_cylinder(double length, double radius, double way, const Medium& medium);

/// The same by the formulas for slender bodies (docs/theory/near_field.md §2).
CylinderForces slender_cylinder(double length, double radius, double way, const Medium& medium);

}  // namespace stylet::validate
