// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/implant/recorded_implant.hpp"
#include "stylet/sim/probe_move.hpp"
#include "stylet/sim/recording.hpp"

#include <chrono>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace stylet {

/// Writes run.h5 (docs/results) during a session of unknown length. A thread of its own writes the added data to the
/// disk five times a second, so a process that is killed loses less than a second. Only write_now() waits for the
/// disk; each add function returns the first error of writing, if there was one.
class RunRecorder {
 public:
  /// @param file is replaced if it exists
  /// @param plan of the seeds that are dropped in this session; null: there is none
  static Result<std::unique_ptr<RunRecorder>> open(const std::filesystem::path& file, const RunInfo& info,
                                                   const TetMesh& mesh, const RecordedPlan* plan = nullptr);
  ~RunRecorder();  ///< writes all added data to the disk

  Result<> add_step(const Step& step);
  Result<> add_event(const Event& event);
  Result<> add_frame(const Frame& frame);  ///< stores the displacement in single precision
  Result<> add_probe_move(const ProbeMove& move);
  // Without a plan, these two are not recorded.
  Result<> add_act(const SeedAct& act);
  Result<> add_dose(const RecordedScore& dose);
  /// Waits until everything added so far is in the file, where a process that is killed leaves it; at most so long.
  void write_now(std::chrono::milliseconds most);

 private:
  struct Parts;
  explicit RunRecorder(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// The text of forces.csv for steps: the header and one line per step.
std::string forces_csv_text(std::span<const Step> steps);

}  // namespace stylet
