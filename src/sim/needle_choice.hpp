// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/cannula.hpp"
#include "stylet/needle/section.hpp"
#include "stylet/sim/scenario.hpp"

namespace stylet {

/// The tube and stylet of a scenario, with defaults filled in.
Cannula cannula_of(const Scenario::NeedleChoice& choice);

/// The needle's section: stiffness computed from tube and stylet, or given by the scenario.
/// @return an input error for an impossible section
Result<NeedleSection> needle_section(const Scenario::NeedleChoice& choice);

/// Axial compliance L / (E A) [mm/N] of the tube.
/// @param choice one for which needle_section() succeeds
double axial_compliance(const Scenario::NeedleChoice& choice);

}  // namespace stylet
