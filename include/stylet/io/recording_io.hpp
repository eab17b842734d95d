// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/implant/recorded_implant.hpp"
#include "stylet/sim/probe_move.hpp"
#include "stylet/sim/recording.hpp"

#include <filesystem>
#include <optional>
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
};

/// Reads a run.h5. If it is still being written, or its writer was killed, the result has everything that had reached
/// the disk. Errors: no such file, not an HDF5 file, not a run, written by a newer version, damaged.
Result<RunRecording> read_recording(const std::filesystem::path& path);

}  // namespace stylet
