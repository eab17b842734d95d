// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene_points.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/serve/picture.hpp"
#include "stylet/sim/recorded_steps.hpp"

#include <memory>
#include <vector>

namespace stylet::serve {

/// A recording that is shown again: pictures of any of its moments, between recorded frames by interpolation. Forces
/// and positions of the base and the tip are those of the step nearest before, at the start those of the first.
class Replay {
 public:
  /// @param points those of the scene
  Replay(RunRecording recording, ScenePoints points);
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  [[nodiscard]] double duration_s() const;
  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] const RunRecording& recording() const { return recording_; }

  void seek(double time_s);
  void play(double rate);  ///< times as fast as it was; from the start again where it has ended; 0 stands
  /// Goes on with playing. @param dt_s [s] on the wall
  void advance(double dt_s);

  /// Regions that the needle is in, that of the tip first: as its events tell, those that it entered and has not been
  /// drawn back out of, by the depth of the base.
  [[nodiscard]] std::vector<std::string> inside() const;

  /// The picture of now, if it has changed since the last one.
  std::shared_ptr<const LiveFrame> picture(bool whole_curve);

 private:
  [[nodiscard]] const Step* step() const;
  void put_frame(LiveFrame& out) const;
  void put_needle(LiveFrame& out) const;

  RunRecording recording_;
  RecordedSteps steps_;  ///< of it
  ScenePoints points_;
  double time_s_ = 0.0;
  double rate_ = 0.0;
  bool changed_ = true;
};

}  // namespace stylet::serve
