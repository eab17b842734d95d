// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/imaging/moment.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/sim/scenario.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet::cli {

/// A patient of whom pictures are made.
struct ImagedCase {
  std::string file;  ///< as the user gave it
  Scenario scenario;
  TetMesh patient;                        ///< empty for a recording, which has its own mesh
  std::optional<RunRecording> recording;  ///< empty: the patient at rest
  std::vector<std::string> notes;         ///< sentences for the user about the patient

  [[nodiscard]] const TetMesh& mesh() const { return recording ? recording->mesh : patient; }
};

/// Opens a scenario file, whose patient is meshed, a saved model, or the run.h5 of a recording.
/// @param settings arguments of --set; a saved model and a recording have a finished mesh, so that settings of
///   [patient] and [mesh] are errors there
Result<ImagedCase> open_imaged_case(const std::string& file, const std::vector<std::string>& settings,
                                    const Progress& progress);

/// The moment that a picture shows.
/// @param time_s empty: the deepest moment of a recording, or the patient at rest
/// Errors: a time for a patient at rest; a time outside of the recording.
Result<Moment> imaged_moment(const ImagedCase& imaged, std::optional<double> time_s);

/// Adds the seeds of a plan, each at its planned place in the tissue, which has carried it along.
/// @param file of the plan: DICOM RTPLAN, plan JSON or CSV
/// Errors: those of read_plan(); a plan without seeds that stay.
Result<> add_planned_seeds(const ImagedCase& imaged, const std::string& file, Moment& moment);

}  // namespace stylet::cli
