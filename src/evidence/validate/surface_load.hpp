// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/kelvinlet.hpp"

namespace stylet::validate {

/// Displacement of the half space z ≥ 0 at x by a unit force on its surface at the origin [mm/N]. Column k is for a
/// force along axis k. Boussinesq's and Cerruti's solutions.
/// @cite Johnson1985 §3.2, §3.6
Mat3 surface_force(const Vec3& x, const Medium& medium);

/// Difference between the solution for a half space z ≥ 0 with a free surface and Kelvin's solution. It is computed by
/// superposition, independently of Mindlin's formula: the opposite of Kelvin's tractions on the plane z = 0 is applied
/// as a load, whose field is the integral of surface_force() over the plane.
/// @param x [mm] point at which the displacement is computed, z ≥ 0
/// @param source [mm] point at which the unit force acts, z > 0
/// @return [mm/N]
Mat3 surface_part(const Vec3& x, const Vec3& source, const Medium& medium);

}  // namespace stylet::validate
