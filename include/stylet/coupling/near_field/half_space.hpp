// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/kelvinlet.hpp"
#include "stylet/coupling/near_field/surface_distance.hpp"

namespace stylet {

/// A plane surface near two points: what the field of a force has to respect beside the medium.
struct SurfacePair {
  Vec3 inwards = Vec3::UnitZ();  ///< unit normal, into the medium
  double at = 0.0;               ///< [mm] depth of the point where the displacement is asked for, ≥ 0
  double on = 0.0;               ///< [mm] depth of the loaded point, ≥ 0
};

/// What a free surface adds to kelvinlet(r, ε): the image part of Mindlin's solution for a force inside a half space,
/// with its distance to the image regularised, R₂ → √(R₂² + ε²) [mm/N]. The two together leave the surface free of
/// traction as far as ε is small against the distances. At the surface they are Boussinesq's and Cerruti's solutions.
/// @param r [mm] from the loaded point to the asked one; only its part along the surface is used
/// @cite Mindlin1936
Mat3 free_surface_image(const Vec3& r, const SurfacePair& surface, double epsilon, const Medium& medium);

/// The same for two points that each know the surface nearest to them, by the share that counts there; nothing where
/// these are two surfaces [mm/N].
Mat3 surface_image(const Vec3& r, const NearSurface& at, const NearSurface& on, double epsilon, const Medium& medium);

}  // namespace stylet
