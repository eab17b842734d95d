// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"
#include "stylet/imaging/moment.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/sim/scenario.hpp"

#include <optional>
#include <vector>

namespace stylet {

/// The moments of a recording, for pictures: displacement and needle are interpolated between the frames before and
/// after a moment, the forces are those of the nearer frame, and the seeds move with the tissue. Behind a needle that
/// has been drawn back, its track is shown.
class RecordedMoments {
 public:
  explicit RecordedMoments(const RunRecording& recording);  ///< keeps a reference: the recording must outlive it

  /// Before the first frame nothing has moved; after the last one the result is the last frame.
  [[nodiscard]] Moment at(double time_s) const;
  /// Where the stepper held the probe; empty: the recording has no probe.
  [[nodiscard]] std::optional<ProbeSettings> probe_at(double time_s) const;
  /// The time of the frame at which the needle is deepest [s]; 0 without a frame.
  [[nodiscard]] double deepest_s() const;

 private:
  [[nodiscard]] std::vector<ShownForce> forces_of(const Frame& frame, const Eigen::Matrix3Xf& displacement) const;
  void add_track(Moment& moment) const;
  void add_seeds(Moment& moment) const;

  const RunRecording& recording_;
  Topology topology_;
  Locator locator_;
  std::optional<Scenario> scenario_;  ///< empty: the recording's scenario cannot be read
};

}  // namespace stylet
