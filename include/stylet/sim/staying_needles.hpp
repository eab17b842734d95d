// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/sim/simulation.hpp"

#include <string>
#include <vector>

namespace stylet {

/// Number of needles that a simulation of this model needs: those that stay, and one for the insertions.
int needles_of(const Model& model);

/// Puts the needles that stay (Model::staying()) into the tissue, one after the other, and takes up the needle for the
/// insertions; the clock starts when it is taken up. Without needles that stay nothing happens.
/// @param simulation new, for needles_of() needles
/// @return sentences about their way in: organs harmed, surfaces unbroken, steps without a balance
/// Errors: those of Simulation::take_up()
Result<std::vector<std::string>> put_in_staying_needles(Simulation& simulation, const Progress& progress);

}  // namespace stylet
