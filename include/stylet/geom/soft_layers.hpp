// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// The soft tissue round the gland that contours and masks do not have, and that decides how far a needle moves the
/// gland. The mesher makes each layer that the input does not have; 0 leaves it out. Sources: docs/meshing.md §3.
struct SoftLayers {
  double periprostatic_fat_mm = 0;  ///< thickness of fat and venous plexus round gland and seminal vesicles
  double levator_mm = 0;            ///< thickness of the muscle round that fat and the rectum, below the gland's base
  double ischiorectal_fat_mm = 0;   ///< width of the fat on either side of the rectum, between levator and skin
  double subcutaneous_fat_mm = 0;   ///< thickness of the perineal skin with its fat, along the patient's axis
  double rectal_wall_mm = 0;        ///< thickness of the rectum's wall; inside it is the lumen

  bool operator==(const SoftLayers&) const = default;
};

/// Those of an adult man.
constexpr SoftLayers typical_layers() {
  return {.periprostatic_fat_mm = 6,
          .levator_mm = 5,
          .ischiorectal_fat_mm = 25,
          .subcutaneous_fat_mm = 8,
          .rectal_wall_mm = 4};
}

}  // namespace stylet
