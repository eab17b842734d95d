// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/cannula.hpp"
#include "stylet/needle/section.hpp"
#include "stylet/sim/scenario.hpp"

namespace stylet {

/// The tube and stylet a scenario describes, its open choices made.
Cannula cannula_of(const Scenario::NeedleChoice& choice);

/// What the needle's models need: the section's stiffness, or what the scenario gives instead.
/// @return input error for a section that cannot be
Result<NeedleSection> needle_section(const Scenario::NeedleChoice& choice);

/// L / (E A) [mm/N] of the tube.
/// @param choice one whose section can be
double axial_compliance(const Scenario::NeedleChoice& choice);

}  // namespace stylet
