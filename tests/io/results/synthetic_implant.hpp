// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/implant_results.hpp"

namespace stylet::testing {

/// An invented outcome of synthetic_dose()'s implant: seeds lie 1 to 3 mm superior of where they were planned, by
/// needle bend, tissue motion and tissue relaxation; the last seed is lost. The delivered dose is the one that was
/// planned.
/// @param grid_mm, step_mm as for synthetic_dose()
ImplantOutcome synthetic_implant(double grid_mm, double step_mm);

}  // namespace stylet::testing
