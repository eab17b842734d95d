// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// Thicknesses [mm] of the soft tissue layers around the gland. Contours and masks usually lack these layers, but they
/// decide how far a needle moves the gland. The mesher adds each layer that the input lacks; 0 leaves a layer out.
/// Sources: docs/meshing.md §3.
struct SoftLayers {
  double periprostatic_fat_mm = 0;  ///< thickness of the fat and venous plexus around gland and seminal vesicles
  double levator_mm = 0;  ///< thickness of the muscle around that fat and the rectum, below the base of the gland
  double ischiorectal_fat_mm = 0;  ///< width of the fat on either side of the rectum, between levator and skin
  double subcutaneous_fat_mm = 0;  ///< thickness of the perineal skin with its fat, along the patient's axis
  double rectal_wall_mm = 0;       ///< thickness of the wall of the rectum; the lumen is inside it

  bool operator==(const SoftLayers&) const = default;
};

/// Thicknesses of the layers of an adult man.
constexpr SoftLayers typical_layers() {
  return {.periprostatic_fat_mm = 6,
          .levator_mm = 5,
          .ischiorectal_fat_mm = 25,
          .subcutaneous_fat_mm = 8,
          .rectal_wall_mm = 4};
}

}  // namespace stylet
