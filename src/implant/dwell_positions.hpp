// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/needle_load.hpp"
#include "stylet/implant/seed_history.hpp"
#include "stylet/sim/simulation.hpp"

#include <vector>

namespace stylet {

/// The moments at which dwell positions are looked at.
enum class DwellLook {
  planning,  ///< when the images are taken on which the dwell times are planned
  delivery   ///< when the dose is delivered
};

/// Looks where the dwell positions of a catheter are: each at its distance behind the tip of the bent catheter, and in
/// which tissue (tissue_of_capsule()). First at planning, which gives the parts of the error by bend, motion and
/// relaxation; then at delivery, which adds the part by the wait between the two.
/// @param number of the catheter in the simulation
/// @param source_length_mm length of the source's capsule, for its axis
/// @param dwells in the order of the load; their numbers and planned places are known
void see_dwell_positions(const NeedleLoad& load, Simulation& simulation, int number, DwellLook look,
                         double source_length_mm, std::vector<SeedHistory>& dwells);

/// The steps of a wait [s], which add up to it. A needle at rest needs short steps at first and ever longer ones later:
/// each is a tenth longer than the one before. The implicit steps are stable at any length.
/// @param wait_s ≥ 0 @param first_s > 0, the first step
std::vector<double> waiting_steps_s(double wait_s, double first_s);

}  // namespace stylet
