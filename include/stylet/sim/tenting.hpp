// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/scenario.hpp"

#include <string>
#include <vector>

namespace stylet {

/// Tenting [mm] of the surface of tissue with these parameters under a force F [N] on a flat punch of the needle's
/// radius R: F (1 − ν²) / (2 R E), or less if the tissue stiffens (docs/theory/stiffening.md).
double tenting_mm(const TissueParameters& tissue, double force_N, double needle_diameter_mm);

/// Cutting lag: displacement [mm] of tissue with these parameters, deep inside the body, under a force [N] on the
/// needle's tip. The tip cuts this far behind the place to which the base has pushed it. Stiffening tissue
/// (docs/theory/stiffening.md) has a smaller lag.
double cutting_lag_mm(const TissueParameters& tissue, double force_N, double needle_diameter_mm);

/// Warnings about implausible tissue parameters, found before anything is simulated: tenting outside 3 … 20 mm, cutting
/// lag above 5 mm.
std::vector<std::string> tenting_warnings(const std::string& region, const TissueParameters& tissue,
                                          double needle_diameter_mm);

}  // namespace stylet
