// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/imaging/pressing_probe.hpp"
#include "stylet/sim/scenario.hpp"

#include <memory>
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
  Moment moment;                   ///< at rest for a scenario; the probe's displacement is not in it
  /// The probe of the scenario, which presses; null: there is none, or it moves nothing (probe.in_contours), or it
  /// cannot be prepared, which `notes` say then.
  std::shared_ptr<PressingProbe> probe{};
  std::vector<std::string> notes;  ///< sentences for the user
};

/// The patient of a scenario or of a saved model, at rest and without a needle, or of a recording, at a moment. A probe
/// that presses is prepared, which takes seconds.
/// @param file SCENARIO.toml, a saved model, or run.h5
/// @param settings keys of the scenario to change, as "KEY=VALUE"; a saved model and a recording have a finished mesh,
///   so that settings of [patient] and [mesh] are errors there
/// @param time_s of a recording; empty: when the needle was deepest
/// Errors: those of reading the file; a time for a patient at rest, or outside of the recording.
Result<ImagedPatient> imaged_patient(const std::string& file, const std::vector<std::string>& settings,
                                     std::optional<double> time_s, const Progress& progress = {});

/// The moment of a patient under the probe where its stepper holds it, which adds to the motion by needles; the moment
/// as it is if no probe presses.
Moment pressed(const ImagedPatient& patient, const ProbeSettings& settings);

/// Adds the seeds of a plan, each at its planned place in the tissue, which has carried it along. With seed.stranded in
/// the scenario spacers join those of a needle.
/// @param file of the plan: DICOM RTPLAN, plan JSON or CSV
/// Errors: those of read_plan(); a plan without seeds that stay.
Result<> add_planned_seeds(ImagedPatient& patient, const std::string& file);

}  // namespace stylet
