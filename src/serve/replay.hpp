// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene_points.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/serve/picture.hpp"
#include "stylet/sim/recorded_steps.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace stylet::serve {

/// Shows a recording again: makes pictures of any moment, with interpolation between recorded frames. Forces and the
/// positions of base and tip are taken from the last step before the moment, at the start from the first step.
class Replay {
 public:
  /// @param points points of the scene
  Replay(RunRecording recording, ScenePoints points);
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  [[nodiscard]] double duration_s() const;
  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] const RunRecording& recording() const { return recording_; }

  void seek(double time_s);
  void play(double rate);  ///< rate × real time; 0 stops; starts again from the beginning if the replay has ended
  /// Advances the replay. @param dt_s [s] wall-clock time since the last call
  void advance(double dt_s);

  /// Regions that contain the needle, the region of the tip first. Derived from the events: regions that were entered
  /// at a depth that the base has not been drawn back from.
  [[nodiscard]] std::vector<std::string> inside() const;

  /// Displacement [mm] LPS of a node of the mesh at the current moment; zero before the first frame.
  [[nodiscard]] Vec3 displacement(Index node) const;

  /// The picture of the current moment; null if it has not changed since the last call.
  std::shared_ptr<const LiveFrame> picture(bool whole_curve);

 private:
  [[nodiscard]] const Step* step() const;
  /// The recorded frames before and after the current moment.
  struct Between {
    const Frame& before;
    const Frame& after;
    double share;  ///< of `after`, 0…1
  };
  [[nodiscard]] std::optional<Between> between() const;
  void put_frame(LiveFrame& out) const;
  void put_needle(LiveFrame& out) const;

  RunRecording recording_;
  RecordedSteps steps_;  ///< of the recording
  ScenePoints points_;
  double time_s_ = 0.0;
  double rate_ = 0.0;
  bool changed_ = true;
};

}  // namespace stylet::serve
