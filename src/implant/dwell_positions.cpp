// SPDX-License-Identifier: GPL-3.0-or-later
#include "dwell_positions.hpp"

#include "drop_seed.hpp"

#include <algorithm>

namespace stylet {

void see_dwell_positions(const NeedleLoad& load, Simulation& simulation, int number, DwellLook look,
                         double source_length_mm, std::vector<SeedHistory>& dwells) {
  const Needle& catheter = simulation.insertion().needle(number);
  const DisplacementAt displacement = displacement_in(simulation);
  for (std::size_t k = 0; k < dwells.size(); ++k) {
    SeedHistory& dwell = dwells[k];
    const double arc_mm = std::max(0.0, catheter.length() - load.seeds[k].behind_tip_mm);
    const Vec3 at = catheter.point(arc_mm);
    const TissueAt tissue = tissue_of_capsule(at, catheter.tangent(arc_mm), source_length_mm, displacement);
    dwell.dropped_mm = at;
    dwell.rest_mm = tissue.rest_mm;
    dwell.axis = tissue.axis;
    dwell.dropped_s = simulation.time_s();
    if (look == DwellLook::planning) {
      dwell.at_planning = DwellAtPlanning{at, tissue.rest_mm};
      dwell.in_tissue = tissue.is_known;
      dwell.explain(load.aim_mm, tissue.lasting_mm);
    } else {
      dwell.in_tissue = dwell.in_tissue && tissue.is_known;
      dwell.by(SeedCause::wait) = tissue.rest_mm - dwell.at_planning->tissue_mm;
    }
  }
}

std::vector<double> waiting_steps_s(double wait_s, double first_s) {
  constexpr double kGrowth = 1.1;
  std::vector<double> steps;
  double left_s = wait_s;
  for (double step_s = first_s; left_s > 0.0; step_s *= kGrowth) {
    // A rest that is shorter than half of the next step is added to this one.
    const bool is_last = left_s < step_s * (1.0 + 0.5 * kGrowth);
    steps.push_back(is_last ? left_s : step_s);
    left_s = is_last ? 0.0 : left_s - step_s;
  }
  return steps;
}

}  // namespace stylet
