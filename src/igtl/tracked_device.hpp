// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"
#include "stylet/realtime/latest_value.hpp"

#include <memory>
#include <utility>

namespace stylet::igtl {

/// The last state of the handle that was received: plain data.
struct TrackedPose {
  bool valid = false;
  PlainPose pose;  ///< LPS
};

/// Passes the pose from the link's thread to the real-time loop.
using PoseChannel = LatestValue<TrackedPose>;

/// A handle that is tracked by the program at the other end of a link. It gives no force feedback itself; the force is
/// sent as messages.
class TrackedDevice final : public Device {
 public:
  TrackedDevice(std::string name, std::shared_ptr<PoseChannel> channel)
      : name_(std::move(name)), channel_(std::move(channel)) {}

  [[nodiscard]] DeviceTraits traits() const override { return {.name = name_}; }

  /// A sample gets the time of the previous call, before the call that finds it. It arrived between the two calls, so
  /// its age is never underestimated. A pose found by the first call has an unknown age and is not valid.
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
