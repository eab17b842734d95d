// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

namespace stylet {

/// Parameters of a steel needle.
struct NeedleSection {
  double length_mm = 200.0;
  double outer_diameter_mm = 1.27;        ///< 18 gauge
  double bending_stiffness_Nmm2 = 15722;  ///< E I; section_stiffness() of a Cannula gives it, as here for its defaults
  double torsion_stiffness_Nmm2 = 12094;  ///< G J
  double bow_mm = 0.0;   ///< offset of the unloaded needle's tip from its axis at the base, constant curvature
  double bow_deg = 0.0;  ///< side of the tip, about the axis, from local x towards local y
};

/// What every needle model asks for: finite positive numbers, a stiffness that steel of this diameter can have, the
/// number of elements within [4, 500], and room for a load.
/// @return an input error that names the number, or Ok
Result<> check_needle(const NeedleSection& section, int elements, int load_capacity);

}  // namespace stylet
