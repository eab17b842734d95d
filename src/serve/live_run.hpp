// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "folder_lock.hpp"
#include "hand.hpp"
#include "pick_up.hpp"
#include "rests.hpp"
#include "scene_points.hpp"
#include "stylet/io/run_recorder.hpp"
#include "stylet/realtime/runner.hpp"
#include "stylet/serve/companion.hpp"
#include "stylet/serve/picture.hpp"
#include "stylet/sim/display_field.hpp"
#include "stylet/sim/display_near_field.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stylet::serve {

/// A model that can be shown.
struct OpenModel {
  std::shared_ptr<const Model> model;
  std::vector<std::string> notes;             ///< LoadedCase::notes
  std::shared_ptr<const DisplayField> field;  ///< empty until it is prepared
  ScenePoints points;                         ///< of the scene
  std::size_t way = 0;                        ///< insertion along whose way the scene is drawn finer

  /// All that a user should know: the notes, then the model's warnings.
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> all = notes;
    all.insert(all.end(), model->warnings().begin(), model->warnings().end());
    return all;
  }
};

/// One insertion at a page: the real-time loop from a needle before the skin until the next one starts, and its
/// recording. All calls from one thread.
class LiveRun {
 public:
  /// @param folder of this recording; made. A disk that refuses does not keep anybody from inserting:
  /// recording_problem() says so.
  /// @param other moves the needle; null: a hand at a page does
  static Result<std::unique_ptr<LiveRun>> start(const OpenModel& open, std::size_t insertion,
                                                const std::filesystem::path& folder, const RunnerSettings& settings,
                                                double recorded_frames_per_s, std::unique_ptr<Device> other);

  ~LiveRun();  ///< the recording is whole afterwards
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// From here on pictures show how the tissue moves, and the recording has frames.
  void set_field(std::shared_ptr<const DisplayField> field);
  /// Passes on what has happened since: to the recording, and the events to `tell`. Often enough that no step is lost.
  void pump(const std::function<void(const LiveEvent&)>& tell);
  /// The newest picture, if there is something in it that was not fetched yet. Its displacement may come later, in a
  /// picture of the same moment.
  /// @param whole_curve with all samples instead of the new ones, and the newest displacement there is
  std::shared_ptr<const LiveFrame> picture(bool whole_curve);
  /// What the last picture shows, and its displacement where that was computed.
  void show_to(Companion& companion);

  [[nodiscard]] RealtimeRunner& runner() { return *runner_; }
  /// Null: another device moves the needle.
  [[nodiscard]] const std::shared_ptr<PageDevice>& hand() const { return hand_; }
  /// Why the companion's device does not move the needle, as of the last show_to(); empty: it does, or a page.
  [[nodiscard]] std::string device_problem(const Companion& companion) const;
  [[nodiscard]] SessionStatus::Loop loop() const;
  /// Ends the recording, and only that; what was recorded is whole.
  void stop_recording(const std::string& why);
  [[nodiscard]] const std::string& recording_problem() const { return problem_; }
  [[nodiscard]] double time_s() const { return time_s_; }
  /// Regions that the needle is in as of the last picture, that of the tip first.
  [[nodiscard]] std::vector<std::string> inside() const;

 private:
  LiveRun(const OpenModel& open, std::size_t insertion, double recorded_frames_per_s);
  void record(const Result<>& done);
  void record_step(const std::optional<Step>& step);
  void record_frame(const Snapshot& snapshot);
  [[nodiscard]] bool displacement_is_due() const;
  void compute_displacement();

  OpenModel open_;
  const PlannedInsertion& plan_;  ///< of the model
  std::shared_ptr<PageDevice> hand_;
  std::shared_ptr<PickUp> other_;  ///< the one of the two that is there moves the needle
  std::unique_ptr<RealtimeRunner> runner_;
  FolderLock in_use_;  ///< the recording
  std::unique_ptr<RunRecorder> recorder_;
  Rests rests_;
  std::string problem_;                     ///< of the recording
  std::optional<DisplayField::Load> load_;  ///< with a field
  DisplayNearField near_;                   ///< of the scene's points
  DisplayNearField near_nodes_;             ///< of the mesh's nodes, for the recording
  Eigen::Matrix3Xf shown_;                  ///< (3 × points of the scene)
  bool seen_ = false;                       ///< there has been a snapshot
  bool owed_ = false;                       ///< the newest snapshot's displacement
  bool shown_anew_ = false;                 ///< since show_to()
  std::vector<Index> all_nodes_;            ///< of the mesh
  std::vector<TissueForce> room_;           ///< for forces
  std::vector<Step> step_room_;
  std::vector<Step> unsent_;  ///< since the last picture
  std::vector<Step> curve_;   ///< since the start, thinned
  double time_s_ = 0.0;
  double frame_every_s_;             ///< of the recording, at least
  double next_frame_s_ = 0.0;        ///< simulated time
  std::optional<Frame> last_frame_;  ///< recorded
  Pose last_base_;                   ///< of it
  double last_force_N_ = 0.0;        ///< of it, axial
  double resting_until_s_ = 0.0;     ///< nothing has moved since it
  double picture_after_s_ = 0.0;     ///< wall: the next displacement for the page
};

}  // namespace stylet::serve
