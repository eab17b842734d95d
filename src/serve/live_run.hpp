// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "folder_lock.hpp"
#include "hand.hpp"
#include "pick_up.hpp"
#include "rests.hpp"
#include "scene_points.hpp"
#include "seed_follower.hpp"
#include "seed_journal.hpp"
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

/// An open model and what is needed to show it.
struct OpenModel {
  std::shared_ptr<const Model> model;
  std::vector<std::string> notes;             ///< LoadedCase::notes
  std::shared_ptr<const DisplayField> field;  ///< empty until it is prepared
  ScenePoints points;                         ///< points of the scene
  std::size_t way = 0;  ///< index of the insertion along whose planned path the scene is drawn finer

  /// All warnings for the user: the notes, then the model's warnings.
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> all = notes;
    all.insert(all.end(), model->warnings().begin(), model->warnings().end());
    return all;
  }
};

/// One insertion of the live page: the real-time loop, from the needle in front of the skin until the next insertion
/// starts, and its recording. All calls from one thread.
class LiveRun {
 public:
  /// Starts the loop and the recording.
  /// @param folder folder of this recording; it is created. If it cannot be written, the insertion runs without a
  /// recording and recording_problem() gives the reason.
  /// @param other device that moves the needle; null: a hand at a page moves it
  /// @param plan the plan of seeds that the needle belongs to, for the recording; null: there is none
  static Result<std::unique_ptr<LiveRun>> start(const OpenModel& open, std::size_t insertion,
                                                const std::filesystem::path& folder, const RunnerSettings& settings,
                                                double recorded_frames_per_s, std::unique_ptr<Device> other,
                                                const RecordedPlan* plan = nullptr);

  ~LiveRun();  ///< completes the recording
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Sets the displacement field. From then on pictures show the motion of the tissue and the recording has frames.
  void set_field(std::shared_ptr<const DisplayField> field);
  /// Fetches the new steps and events, records them and passes the events to `tell`. Must be called before the runner's
  /// buffer of steps is full; otherwise steps are lost.
  void pump(const std::function<void(const LiveEvent&)>& tell);
  /// The newest picture; null if nothing is new since the last call. The displacement may follow later, in another
  /// picture of the same moment.
  /// @param whole_curve the picture holds all samples of the curve instead of the new ones, and the newest displacement
  std::shared_ptr<const LiveFrame> picture(bool whole_curve);
  /// Passes the state that the last picture shows to a companion, and its displacement if there is a new one.
  void show_to(Companion& companion);

  [[nodiscard]] RealtimeRunner& runner() { return *runner_; }
  /// Drops and follows the seeds of an implant.
  [[nodiscard]] SeedFollower& seeds() { return seeds_; }
  /// Records what has changed of the implant since the last call (SeedJournal::news()), and the next picture.
  void record_implant(const LiveImplant& implant, bool score_is_current);
  /// Records where the stepper holds the probe, if there is one and it has moved since the last call.
  void record_probe(const ProbeSettings& probe);
  /// Records a frame of the next picture, although the last one was recorded a short time ago.
  void record_next_picture() { next_frame_s_ = 0.0; }

  /// The hand at a page; null if another device moves the needle.
  [[nodiscard]] const std::shared_ptr<PageDevice>& hand() const { return hand_; }
  /// Why the companion's device did not move the needle at the last show_to(); empty if it did, or if a page moves it.
  [[nodiscard]] std::string device_problem(const Companion& companion) const;
  [[nodiscard]] SessionStatus::Loop loop() const;
  /// Completes and ends the recording; the loop continues.
  void stop_recording(const std::string& why);
  [[nodiscard]] const std::string& recording_problem() const { return problem_; }
  [[nodiscard]] double time_s() const { return time_s_; }
  /// Regions that contained the needle in the last picture, the region of the tip first.
  [[nodiscard]] std::vector<std::string> inside() const;

 private:
  LiveRun(const OpenModel& open, std::size_t insertion, double recorded_frames_per_s);
  void record(const Result<>& done);
  void record_step(const std::optional<Step>& step);
  void record_frame(const Snapshot& snapshot);
  [[nodiscard]] bool displacement_is_due() const;
  void compute_displacement();

  OpenModel open_;
  const PlannedInsertion& plan_;  ///< part of the model
  std::shared_ptr<PageDevice> hand_;
  std::shared_ptr<PickUp> other_;  ///< either hand_ or other_ is set; it moves the needle
  SeedFollower seeds_;
  std::unique_ptr<RealtimeRunner> runner_;
  FolderLock in_use_;  ///< locks the folder of the recording
  std::unique_ptr<RunRecorder> recorder_;
  Rests rests_;
  SeedJournal journal_;
  std::string problem_;                     ///< why nothing is recorded
  std::optional<DisplayField::Load> load_;  ///< set if there is a field
  DisplayNearField near_;                   ///< near field at the points of the scene
  DisplayNearField near_nodes_;             ///< near field at the nodes of the mesh, for the recording
  Eigen::Matrix3Xf shown_;                  ///< [mm] (3 × points of the scene) the displacement that is shown
  bool seen_ = false;                       ///< a snapshot has been fetched
  bool owed_ = false;                       ///< the displacement of the newest snapshot has not been computed
  bool shown_anew_ = false;                 ///< shown_ has changed since show_to()
  std::vector<Index> all_nodes_;            ///< all node indices of the mesh
  std::vector<TissueForce> room_;           ///< buffer for forces
  std::vector<Step> step_room_;             ///< buffer for steps
  std::vector<Step> unsent_;                ///< steps since the last picture
  std::vector<Step> curve_;                 ///< steps since the start, thinned
  double time_s_ = 0.0;
  double frame_every_s_;                     ///< least simulated time between recorded frames
  double next_frame_s_ = 0.0;                ///< simulated time of the next recorded frame
  std::optional<Frame> last_frame_;          ///< the last recorded frame
  std::optional<ProbeSettings> last_probe_;  ///< that was recorded
  Pose last_base_;                           ///< base in last_frame_
  double last_force_N_ = 0.0;                ///< axial force in last_frame_
  double resting_until_s_ = 0.0;             ///< nothing has moved from last_frame_ until this simulated time
  double picture_after_s_ = 0.0;  ///< wall-clock time after which the next displacement is computed for the page
};

}  // namespace stylet::serve
