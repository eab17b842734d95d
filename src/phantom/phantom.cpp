// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/phantom/phantom.hpp"

#include "anatomy.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

ContourSet demo_patient(const PhantomOptions& options) {
  using namespace phantom;
  const double spacing = std::isfinite(options.slice_spacing_mm) ? std::clamp(options.slice_spacing_mm, 1.0, 8.0) : 5.0;
  const Sizes sizes = sizes_of(options.seed);
  Random random(options.seed ^ 0x57494C4554ULL);  // shapes vary independently of sizes

  const Prostate prostate(sizes, random);
  const Urethra urethra(sizes, prostate);
  const Bladder bladder(sizes, prostate, random);
  const Rectum rectum(sizes, prostate, random);
  const PubicArch arch(sizes, prostate, random);
  const Band band(prostate, urethra, arch);
  const Body body(sizes, prostate, random);

  ContourSet set;
  set.source = "demo patient";
  set.label = "Demo patient " + std::to_string(options.seed);
  for (const Organ* organ :
       std::initializer_list<const Organ*>{&prostate, &urethra, &bladder, &rectum, &arch, &band, &body}) {
    Roi roi;
    roi.name = organ->name;
    roi.number = static_cast<int>(set.rois.size()) + 1;
    roi.type = organ->type;
    roi.colour = organ->colour;
    for (int k = static_cast<int>(std::ceil(organ->low / spacing)); k * spacing <= organ->high; ++k) {
      const double z = k * spacing;
      for (const Outline& outline : organ->outlines(z)) roi.contours.push_back(at_height(outline, z));
    }
    set.rois.push_back(std::move(roi));
  }
  return set;
}

}  // namespace stylet
