// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy.hpp"

namespace stylet::phantom {

Sizes sizes_of(std::uint64_t seed) {
  Sizes sizes;
  if (seed == 0) return sizes;  // the documented reference patient
  Random random(seed);
  sizes.prostate_cc = random.around(44.0, 12.0);
  sizes.prostate_width = random.around(sizes.prostate_width, 0.08);
  sizes.prostate_length = random.around(sizes.prostate_length, 0.08);
  sizes.prostate_hollow = random.around(sizes.prostate_hollow, 0.8);
  sizes.urethra_diameter = random.around(6.5, 0.5);
  sizes.bladder_cc = random.around(125.0, 22.0);
  sizes.rectum_diameter = random.around(30.0, 4.5);
  sizes.rectum_gap = random.around(sizes.rectum_gap, 0.8);
  sizes.retropubic_gap = random.around(8.0, 1.5);
  sizes.subpubic_angle = random.around(sizes.subpubic_angle, 8.0);
  sizes.skin_below_apex = random.around(sizes.skin_below_apex, 4.0);
  sizes.body_width = random.around(sizes.body_width, 8.0);
  sizes.body_depth = random.around(sizes.body_depth, 8.0);
  return sizes;
}

}  // namespace stylet::phantom
