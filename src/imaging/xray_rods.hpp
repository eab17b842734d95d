// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/imaging/moment.hpp"
#include "stylet/imaging/xray_geometry.hpp"

#include <span>

namespace stylet {

// Thin bodies that are not in the mesh: each function adds the attenuation of one of them along the rays of a picture
// and does not allocate. Sums are as in XraySurfaces::add(). A pixel gets the mean over 3 × 3 rays, because these
// bodies are as thin as a pixel.

/// Adds the wall of a tube along a polyline: a needle, with `per_mm` of its material; its lumen is taken to hold
/// something that attenuates like tissue.
/// @param per_mm attenuation that the wall adds [1/mm]
void add_tube(const XrayGeometry& unit, std::span<const Vec3> centreline_mm, double diameter_mm,
              double lumen_diameter_mm, double per_mm, std::span<float> sums);

/// Adds a ball. @param per_mm attenuation that it adds to its surroundings [1/mm]
void add_ball(const XrayGeometry& unit, const Vec3& centre_mm, double radius_mm, double per_mm, std::span<float> sums);

/// Attenuation of the parts of a seed [1/mm].
struct SeedAttenuation {
  double capsule_per_mm = 0.0;
  double core_per_mm = 0.0;
};

/// Adds a seed: a capsule of titanium with a wall of 0.05 mm and, in its axis, a rod of silver of 5/8 of its diameter
/// and 2/3 of its length. The seed of model 6711 has these proportions (capsule 4.5 mm × 0.8 mm, rod 3.0 mm × 0.5 mm:
/// Rivard et al. 2004, Med Phys 31:633).
void add_seed(const XrayGeometry& unit, const ShownSeed& seed, const SeedAttenuation& attenuation,
              std::span<float> sums);

}  // namespace stylet
