// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/kelvinlet.hpp"
#include "stylet/coupling/near_field/surface_distance.hpp"

namespace stylet {

/// A plane free surface and the depths of two points below it: the argument of free_surface_image().
struct SurfacePair {
  Vec3 inwards = Vec3::UnitZ();  ///< unit normal, into the medium
  double at = 0.0;               ///< [mm] depth of the displaced point, ≥ 0
  double on = 0.0;               ///< [mm] depth of the loaded point, ≥ 0
};

/// The part that a free surface adds to kelvinlet(r, ε): the image part of Mindlin's solution for a force inside a half
/// space, with the distance to the image regularised, R₂ → √(R₂² + ε²) [mm/N]. The sum of the two leaves the surface
/// free of traction as far as ε is small against the distances. At the surface the sum is Boussinesq's and Cerruti's
/// solution.
/// @param r [mm] vector from the loaded point to the displaced point; only its part along the surface is used
/// @cite Mindlin1936
Mat3 free_surface_image(const Vec3& r, const SurfacePair& surface, double epsilon, const Medium& medium);

/// free_surface_image() [mm/N] for two points that each have their own nearest surface, multiplied by
/// NearSurface::share; zero if the two points are near different surfaces.
Mat3 surface_image(const Vec3& r, const NearSurface& at, const NearSurface& on, double epsilon, const Medium& medium);

}  // namespace stylet
