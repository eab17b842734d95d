// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "frame_news.hpp"
#include "hand.hpp"
#include "live_recording.hpp"
#include "live_view.hpp"
#include "pick_up.hpp"
#include "stylet/realtime/runner.hpp"
#include "stylet/serve/companion.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stylet::serve {

/// One insertion of the live page: the real-time loop, from the needle in front of the skin until the next insertion
/// starts, and its recording. All calls from one thread.
class LiveRun {
 public:
  /// Starts the loop and the recording.
  /// @param folder folder of this recording; it is created. If it cannot be written, the insertion runs without a
  /// recording and recording_problem() gives the reason.
  /// @param other device that moves the needle; null: a hand at a page moves it
  /// @param plan the plan of seeds that the needle belongs to, for the recording; null: there is none
  /// @param say is told of what happened to the needles that stay on their way in; may be empty
  static Result<std::unique_ptr<LiveRun>> start(const OpenModel& open, std::size_t insertion,
                                                const std::filesystem::path& folder, const RunnerSettings& settings,
                                                double recorded_frames_per_s, std::unique_ptr<Device> other,
                                                const RecordedPlan* plan = nullptr,
                                                const std::function<void(const std::string&)>& say = {});

  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Sets the displacement field. From then on pictures show the motion of the tissue and the recording has frames.
  void set_field(std::shared_ptr<const DisplayField> field);
  /// Fetches the new steps and events, records them and passes the events to `tell`. Must be called before the runner's
  /// buffer of steps is full; otherwise steps are lost.
  void pump(const std::function<void(const Event&)>& tell);
  /// The newest picture; null if it would show nothing new, but for a few each second as a sign of life (FrameNews).
  /// The displacement may follow later, in another picture of the same moment, and is left out where nothing has moved.
  /// @param whole_curve the picture holds all samples of the curve instead of the new ones, and the newest displacement
  std::shared_ptr<const LiveFrame> picture(bool whole_curve);
  /// Passes the state that the last picture shows to a companion, and its displacement if there is a new one.
  void show_to(Companion& companion);

  [[nodiscard]] RealtimeRunner& runner() { return *runner_; }
  /// Drops and follows the seeds of an implant.
  [[nodiscard]] SeedFollower& seeds() { return seeds_; }
  /// Records what has changed of the implant since the last call, and the next picture.
  void record_implant(const LiveImplant& implant, bool score_is_current);
  void record_probe(const ProbeSettings& probe) { recording_.add(probe, time_s_); }
  /// RecordedFrames::hurry()
  void record_next_picture() { frames_.hurry(); }

  /// The hand at a page; null if another device moves the needle.
  [[nodiscard]] const std::shared_ptr<PageDevice>& hand() const { return hand_; }
  /// Why the companion's device did not move the needle at the last show_to(); empty if it did, or if a page moves it.
  [[nodiscard]] std::string device_problem(const Companion& companion) const;
  [[nodiscard]] SessionStatus::Loop loop() const;
  /// Completes and ends the recording; the loop continues.
  void stop_recording(const std::string& why) { recording_.stop(why); }
  [[nodiscard]] const std::string& recording_problem() const { return recording_.problem(); }
  [[nodiscard]] double time_s() const { return time_s_; }
  /// How far a seed that is pushed out of the tip now would rest from where a rigid straight needle on the same base
  /// leaves it in a patient that nothing has moved [mm]; empty: not known, or the tip is not in the tissue.
  [[nodiscard]] std::optional<double> seed_off_mm() const { return seeds_.forecast().off_mm(); }
  /// Regions that contained the needle in the last picture, the region of the tip first.
  [[nodiscard]] std::vector<std::string> inside() const;

 private:
  LiveRun(const OpenModel& open, std::size_t insertion, double recorded_frames_per_s);
  void foretell_seed(const Snapshot& now);

  std::shared_ptr<const Model> model_;
  const PlannedInsertion& plan_;  ///< part of the model
  std::shared_ptr<PageDevice> hand_;
  std::shared_ptr<PickUp> other_;  ///< either hand_ or other_ is set; it moves the needle
  SeedFollower seeds_;
  std::unique_ptr<RealtimeRunner> runner_;
  LiveRecording recording_;
  RecordedFrames frames_;
  TissueView view_;
  LiveCurve curve_;
  FrameNews news_;
  bool seen_ = false;                    ///< a snapshot has been fetched
  std::vector<TissueForce> force_room_;  ///< buffer for forces
  std::vector<Step> step_room_;          ///< buffer for steps
  double time_s_ = 0.0;
};

}  // namespace stylet::serve
