// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/dose/evaluate.hpp"
#include "stylet/implant/needle_load.hpp"
#include "stylet/patient/dose_structures.hpp"
#include "stylet/sim/scenario.hpp"

#include <string>
#include <vector>

namespace stylet {

/// The plan of an implant with everything that its dose depends on.
struct ImplantPlan {
  DosePlan plan;
  SourceModel source;
  std::vector<NeedleLoad> needles;  ///< in the order of the procedure
  DoseStructures structures;        ///< of the patient, sampled
  DoseOptions options;              ///< the scenario's goals and swelling
};

/// Reads the plan of a scenario, the source model of its seeds and the structures of its patient.
/// @param scenario with a plan; paths in it are relative to the current folder
/// @param where name of the scenario in messages
/// Errors: no plan; those of reading plan, source and patient and of load_needles() or load_catheters(); a plan with
/// another frame of reference than the patient's contours; a temporary implant with a key that is for permanent ones.
Result<ImplantPlan> read_implant_plan(const Scenario& scenario, const std::string& where,
                                      const Progress& progress = {});

}  // namespace stylet
