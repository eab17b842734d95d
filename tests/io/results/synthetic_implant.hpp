// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/implant_results.hpp"

namespace stylet::testing {

/// An invented outcome of synthetic_dose()'s implant: seeds lie 1 to 3 mm superior of where they were planned, by
/// needle bend, tissue motion and tissue relaxation; the last seed is lost. Two needles stabilise, the gland swells,
/// and each needle has some steps, two events and three shapes. The delivered dose is the one that was planned.
/// @param grid_mm, step_mm as for synthetic_dose()
ImplantOutcome synthetic_implant(double grid_mm, double step_mm);

/// Adds seeds that were found on images: all but two, with a common shift of (0.4, −0.9, −1.5) mm, an error of about a
/// millimetre and half of the simulated error once more, in another order; and one that was never dropped. Their dose
/// is the delivered one.
void add_invented_found_seeds(ImplantOutcome& outcome);

}  // namespace stylet::testing
