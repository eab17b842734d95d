// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/imaging/moment.hpp"
#include "stylet/sim/scenario.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// A patient of whom pictures are made.
struct ImagedPatient {
  Scenario scenario;               ///< of the file; its tables probe, ultrasound and fluoroscopy say how
  TetMesh mesh;                    ///< undeformed
  std::vector<int> gland_regions;  ///< numbers of regions
  std::vector<TissueEcho> echoes;  ///< (regions)
  Moment moment;                   ///< at rest for a scenario
  std::vector<std::string> notes;  ///< sentences for the user
};

/// The patient of a scenario or of a saved model, at rest and without a needle, or of a recording, at a moment.
/// @param file SCENARIO.toml, a saved model, or run.h5
/// @param settings keys of the scenario to change, as "KEY=VALUE"; a saved model and a recording have a finished mesh,
///   so that settings of [patient] and [mesh] are errors there
/// @param time_s of a recording; empty: when the needle was deepest
/// Errors: those of reading the file; a time for a patient at rest, or outside of the recording.
Result<ImagedPatient> imaged_patient(const std::string& file, const std::vector<std::string>& settings,
                                     std::optional<double> time_s, const Progress& progress = {});

/// Adds the seeds of a plan, each at its planned place in the tissue, which has carried it along.
/// @param file of the plan: DICOM RTPLAN, plan JSON or CSV
/// Errors: those of read_plan(); a plan without seeds that stay.
Result<> add_planned_seeds(ImagedPatient& patient, const std::string& file);

}  // namespace stylet
