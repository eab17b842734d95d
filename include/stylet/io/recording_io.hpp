// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/implant/recorded_implant.hpp"
#include "stylet/sim/probe_move.hpp"
#include "stylet/sim/recording.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// The content of a run.h5: enough to replay the run and to write all other result files again.
struct RunRecording {
  RunInfo info;
  TetMesh mesh;
  std::vector<Step> steps;
  std::vector<Frame> frames;                 ///< displacements in single precision
  std::optional<Summary> summary;            ///< empty while the run goes on, or if it was killed
  std::vector<Event> events{};               ///< events of the run; if the run was killed, only a live session has them
  std::optional<RecordedImplant> implant{};  ///< seeds of a live session; empty without a plan of seeds
  /// The way of the probe in a live session, in order of time: each place holds until the next one. Of each, the place
  /// on the stepper and the sizes were recorded; the other settings are those of the scenario. Empty where the probe of
  /// the scenario, if it has one, stays in its place.
  std::vector<ProbeMove> probe_moves{};
  bool has_ended = false;  ///< its writer has closed it: the run was finished, or its needle was laid aside
};

/// Reads a run.h5. If it is still being written, or its writer was killed, the result has everything that had reached
/// the disk. Errors: no such file, not an HDF5 file, not a run, written by a newer version, damaged.
Result<RunRecording> read_recording(const std::filesystem::path& path);

/// The content of a run.h5 without what is long: steps, frames and mesh.
struct RecordingHead {
  std::string scenario_name;
  double duration_s = 0.0;         ///< [s] simulated time
  std::optional<double> most_N{};  ///< [N] largest axial force; empty where looking for it would take long
  bool has_ended = false;          ///< RunRecording::has_ended
  std::vector<Event> events{};
  std::optional<RecordedImplant> implant{};
};

/// Reads the heads of many recordings at once. Errors: those of read_recording(), for each file.
std::vector<Result<RecordingHead>> read_recording_heads(std::span<const std::filesystem::path> files);

/// SHA-256 of the needles and seeds of a plan and of its source, which the recordings of all its needles share.
std::string digest_of_plan(const RecordedPlan& plan);

}  // namespace stylet
