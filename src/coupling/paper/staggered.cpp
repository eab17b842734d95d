// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/insertion_parts.hpp"

namespace stylet {
void Insertion::Parts::solve_staggered(double h, StepReport& report) { solve_equilibrium(h, report); }
}  // namespace stylet
