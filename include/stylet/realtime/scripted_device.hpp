// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"
#include "stylet/sim/motion.hpp"

namespace stylet {

/// A device whose handle follows a given motion regardless of forces: for demonstrations, tests and measurements.
class ScriptedDevice final : public Device {
 public:
  explicit ScriptedDevice(BaseMotion motion) : motion_(std::move(motion)) {}

  [[nodiscard]] DeviceTraits traits() const override { return {.name = "script", .force = true, .torque = true}; }
  DeviceInput read(const DeviceTime& time) noexcept override {
    return {.time_s = time.now_s, .valid = true, .pose = plain(motion_.at(time.simulated_s))};
  }
  void write(const Wrench& /*on_hand*/) noexcept override {}

 private:
  BaseMotion motion_;
};

}  // namespace stylet
