// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/implant_results.hpp"

#include <filesystem>
#include <string>

namespace stylet {

/// Choices for implant().
struct ImplantSettings {
  int compensate =
      0;              ///< rounds in which the needles are aimed so that the seeds rest where they were planned; 0: none
  bool span = false;  ///< also with the tissue presets `firm` and `soft`, where the scenario has `typical`
};

/// Carries out the plan of a scenario in its patient: meshes the patient, simulates all needles, and computes the dose
/// that was planned and the dose that the seeds give where they come to rest. It takes minutes.
/// @param scenario with plan.file; paths in it are relative to the current folder
/// @param where name of the scenario in messages
/// Errors: no plan; those of reading plan, source and patient, of simulate_implant() and of evaluate_dose(); a plan
/// with another frame of reference than the patient's contours.
Result<ImplantOutcome> implant(const Scenario& scenario, const std::string& where, const ImplantSettings& settings = {},
                               const Progress& progress = {});

}  // namespace stylet
