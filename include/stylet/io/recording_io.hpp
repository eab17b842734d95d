// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/sim/recording.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace stylet {

/// A run as its run.h5 holds it: enough to replay it and to make every other result file again.
struct RunRecording {
  RunInfo info;
  TetMesh mesh;
  std::vector<Step> steps;
  std::vector<Frame> frames;       ///< displacements were stored with single precision
  std::optional<Summary> summary;  ///< empty while the run goes on, or when it was killed
  std::vector<Event> events{};     ///< of a live session also when it was killed
};

/// Reads a run.h5, also one that is being written or whose writer was killed: what had reached the disk is returned.
/// Errors: no such file, not an HDF5 file, not a run, written by a newer version, damaged.
Result<RunRecording> read_recording(const std::filesystem::path& path);

}  // namespace stylet
