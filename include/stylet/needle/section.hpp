// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

namespace stylet {

/// Parameters of a steel needle.
struct NeedleSection {
  double length_mm = 200.0;
  double outer_diameter_mm = 1.27;        ///< [mm], 18 gauge
  double bending_stiffness_Nmm2 = 15722;  ///< E I [N mm²]; the default is section_stiffness() of a default Cannula
  double torsion_stiffness_Nmm2 = 12094;  ///< G J [N mm²]
  double bow_mm = 0.0;  ///< [mm] distance of the unloaded tip from the axis at the base; the bow has constant curvature
  double bow_deg = 0.0;  ///< [°] side of the tip, measured about the axis from local x towards local y
};

/// Checks the requirements of every needle model: numbers that are finite and positive, a stiffness that is possible
/// for steel of this diameter, a bow of at most a tenth of the length, 4 to 500 elements, and room for at least one
/// load.
/// @return Ok, or an input error that names the wrong number
Result<> check_needle(const NeedleSection& section, int elements, int load_capacity);

}  // namespace stylet
