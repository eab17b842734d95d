// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/kelvinlet.hpp"

namespace stylet::validate {

/// Displacement of the half space z ≥ 0 at x by a unit force on its surface at the origin [mm/N]: column k for a force
/// along axis k. Boussinesq's and Cerruti's solutions.
/// @cite Johnson1985 §3.2, §3.6
Mat3 surface_force(const Vec3& x, const Medium& medium);

/// What the free surface of the half space z ≥ 0 adds to Kelvin's solution, by superposition and without Mindlin's
/// formula: Kelvin's tractions on the plane z = 0 are taken away by the opposite load on the surface, whose field is
/// the integral of surface_force() over the plane.
/// @param x [mm] where the displacement is asked for, z ≥ 0
/// @param source [mm] where the unit force is, z > 0
/// @return [mm/N]
Mat3 surface_part(const Vec3& x, const Vec3& source, const Medium& medium);

}  // namespace stylet::validate
