// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "exchange.hpp"
#include "stylet/realtime/passivity.hpp"
#include "stylet/realtime/period_grid.hpp"
#include "stylet/realtime/runner.hpp"

namespace stylet {

/// The device's thread. In each turn it passes the handle's pose to the step's thread, computes the coupling's force
/// and sends it through passivity control and force guard to the device. Its work is small and constant, so it keeps
/// its period even if a step does not. Nothing in run() allocates, locks, throws or logs.
class DeviceLoop {
 public:
  DeviceLoop(Device& device, const std::optional<VirtualCoupling>& coupling, const ForceGuard& guard,
             const RunnerSettings& settings, Exchange& exchange, LoopTimes& times);

  /// Runs until Exchange::stop is set and the force has then faded to zero.
  /// @param clock_zero_ns start of the runner's clock, on CLOCK_MONOTONIC @param origin_ns time of the first turn
  void run(std::int64_t clock_zero_ns, std::int64_t origin_ns) noexcept;

 private:
  void turn(double now_s, double dt, bool stopping);
  void follow_handle(const DeviceInput& input, double dt);
  [[nodiscard]] Wrench on_hand() const;

  Device& device_;
  std::optional<VirtualCoupling> coupling_;
  ForceGuard guard_;
  PassivityControl passivity_;
  const RunnerSettings& settings_;
  Exchange& exchange_;
  LoopTimes& times_;
  std::int64_t period_ns_;
  bool tracked_ = false;  ///< handle_ is the one of the last turn
  Pose handle_;
  Twist twist_;  ///< of the handle
};

}  // namespace stylet
