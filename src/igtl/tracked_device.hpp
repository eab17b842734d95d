// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"
#include "stylet/realtime/latest_value.hpp"

#include <memory>
#include <utility>

namespace stylet::igtl {

/// What the other side last said of the handle: plain data.
struct TrackedPose {
  bool valid = false;
  PlainPose pose;  ///< LPS
};

/// From the link's thread to the loop's.
using PoseChannel = LatestValue<TrackedPose>;

/// A handle that somebody tracks at the other end of a link. It feels nothing: its force goes out as messages.
class TrackedDevice final : public Device {
 public:
  TrackedDevice(std::string name, std::shared_ptr<PoseChannel> channel)
      : name_(std::move(name)), channel_(std::move(channel)) {}

  [[nodiscard]] DeviceTraits traits() const override { return {.name = name_}; }

  /// A sample is stamped with the turn before the one that finds it: it arrived between the two, so it is never taken
  /// for younger than it is. What is there at the first turn is of unknown age, and no sample.
  DeviceInput read(const DeviceTime& time) noexcept override {
    if (channel_->fetch()) {
      known_age_ = turned_;
      stamp_s_ = last_turn_s_;
    }
    turned_ = true;
    last_turn_s_ = time.now_s;
    const TrackedPose& newest = channel_->value();
    return {.time_s = stamp_s_, .valid = known_age_ && newest.valid, .pose = newest.pose};
  }
  void write(const Wrench& /*on_hand*/) noexcept override {}

 private:
  std::string name_;
  std::shared_ptr<PoseChannel> channel_;
  bool turned_ = false;
  bool known_age_ = false;
  double last_turn_s_ = 0.0;
  double stamp_s_ = 0.0;
};

}  // namespace stylet::igtl
