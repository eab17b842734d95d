// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "folder_lock.hpp"
#include "rests.hpp"
#include "seed_journal.hpp"
#include "stylet/io/run_recorder.hpp"
#include "stylet/realtime/snapshot.hpp"
#include "stylet/sim/display_field.hpp"
#include "stylet/sim/display_near_field.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet::serve {

/// The recording of a live run: its steps without the rests, its events, its frames, the acts of its implant and the
/// moves of its probe. It ends with the object, or where it cannot be written; the run goes on then.
class LiveRecording {
 public:
  LiveRecording() = default;
  ~LiveRecording() { end_rest(); }
  LiveRecording(const LiveRecording&) = delete;
  LiveRecording& operator=(const LiveRecording&) = delete;

  /// Begins the recording. If it cannot be written, nothing is recorded and problem() gives the reason.
  /// @param folder is created @param plan the plan of seeds that the needle belongs to; null: there is none
  void begin(const std::filesystem::path& folder, const RunInfo& info, const TetMesh& mesh, const RecordedPlan* plan);
  [[nodiscard]] bool is_on() const { return recorder_ != nullptr; }
  /// Why nothing is recorded, or what is missing; empty: all is well.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// Says that something is missing; the recording goes on.
  void lacks(const std::string& what);
  /// Completes and ends the recording.
  void stop(const std::string& why);

  void add(const Step& step);
  void add(const Event& event);
  void add(const Frame& frame);
  /// Records what has changed of the implant since the last call (SeedJournal::news()). Changes of seeds are in the
  /// file when it returns, so that no page sees a seed that a killed server would lose.
  /// @return whether seeds were dropped, moved or taken back
  bool add(const LiveImplant& implant, bool score_is_current, double time_s);
  /// Records where the stepper holds the probe, if there is one and it has moved since the last call.
  void add(const ProbeSettings& probe, double time_s);

 private:
  void end_rest();
  void note(const Result<>& done);

  FolderLock in_use_;  ///< locks the folder
  std::unique_ptr<RunRecorder> recorder_;
  Rests rests_;
  SeedJournal journal_;
  std::string problem_;
  std::optional<ProbeSettings> last_probe_;  ///< that was recorded
};

/// The frames of a recording: at most so many a second, and none while the needle rests.
class RecordedFrames {
 public:
  RecordedFrames(const std::shared_ptr<const Model>& model, double frames_per_s);

  /// Records a frame of the next picture, although the last one was recorded a short time ago.
  void hurry() { next_s_ = 0.0; }
  [[nodiscard]] bool is_due(const Snapshot& snapshot) const { return snapshot.step.time_s >= next_s_; }
  /// Records a frame unless the needle rests.
  /// @param load of the field by `forces`, which are those of the snapshot
  void record(const Snapshot& snapshot, std::span<const TissueForce> forces, const DisplayField& field,
              DisplayField::Load& load, LiveRecording& recording);

 private:
  DisplayNearField near_;         ///< near field at the nodes of the mesh
  std::vector<Index> nodes_;      ///< all node indices of the mesh
  double every_s_;                ///< least simulated time between frames
  double next_s_ = 0.0;           ///< simulated time of the next frame
  std::optional<Frame> last_;     ///< the last frame
  Pose last_base_;                ///< base in last_
  double last_force_N_ = 0.0;     ///< axial force in last_
  double resting_until_s_ = 0.0;  ///< nothing has moved from last_ until this simulated time
};

}  // namespace stylet::serve
