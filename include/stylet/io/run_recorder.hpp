// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/sim/recording.hpp"

#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace stylet {

/// Writes run.h5 (docs/results.md) while something goes on whose end nobody knows: a thread of its own brings what is
/// added to the disk five times a second, so a process that is killed loses less than a second. Calls never wait for
/// the disk; they return its first error, if there was one.
class RunRecorder {
 public:
  /// @param file replaced if it is there
  static Result<std::unique_ptr<RunRecorder>> open(const std::filesystem::path& file, const RunInfo& info,
                                                   const TetMesh& mesh);
  ~RunRecorder();  ///< what was added is on the disk afterwards

  Result<> add_step(const Step& step);
  Result<> add_event(const Event& event);
  Result<> add_frame(const Frame& frame);  ///< displacement with single precision

 private:
  struct Parts;
  explicit RunRecorder(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// forces.csv of steps: the header and a line for each.
std::string forces_csv_text(std::span<const Step> steps);

}  // namespace stylet
