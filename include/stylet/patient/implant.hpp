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
  std::filesystem::path found;         ///< file of the seeds that were found on images after the implant; empty: none
  std::filesystem::path patient_from;  ///< DICOM file that decides whose plan it is; empty: the inputs do
};

/// Carries out the plan of a scenario in its patient: meshes the patient, simulates all needles, and computes the dose
/// that was planned and the dose that the seeds give where they come to rest. It takes minutes. Seeds that were found
/// on images are compared with those of the simulation; they are read and checked before anything is computed. The
/// dwell positions of a temporary implant are where they are at the delivery.
/// @param scenario with a plan; paths in it are relative to the current folder
/// @param where name of the scenario in messages
/// Errors: no plan; those of reading plan, source and patient, of simulate_implant() and of evaluate_dose(); a plan
/// with another frame of reference than the patient's contours; those of read_found_seeds() and check_found_seeds();
/// found seeds together with compensation, which no implant that was carried out had; either of them with a temporary
/// implant.
Result<ImplantOutcome> implant(const Scenario& scenario, const std::string& where, const ImplantSettings& settings = {},
                               const Progress& progress = {});

}  // namespace stylet
