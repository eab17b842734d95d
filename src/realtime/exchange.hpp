// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "event_queue.hpp"
#include "stylet/realtime/deadline_histogram.hpp"
#include "stylet/realtime/device.hpp"
#include "stylet/realtime/latest_value.hpp"
#include "stylet/realtime/snapshot.hpp"

#include <atomic>

namespace stylet {

/// What the device's thread needs of a step.
struct StepResult {
  PlainPose base;
  Triple velocity{};          ///< [mm/s] LPS, of the base
  Triple angular_velocity{};  ///< [rad/s]
  PlainWrench hand;           ///< exerted by the hand on the base
  double clock_s = -1e300;    ///< when it was known
  double simulated_s = 0.0;
  bool good = false;  ///< trusted, and the simulation is not paused
};

/// All that passes between the threads of a runner, every item with one writer and one reader; commands with any number
/// of writers. Nothing here waits.
struct Exchange {
  static constexpr std::size_t kEvents = 1024;
  static constexpr std::size_t kSteps = 4096;

  LatestValue<DeviceInput> input;             ///< device → step
  LatestValue<StepResult> result;             ///< step → device
  LatestValue<Snapshot> snapshot;             ///< step → reader
  LatestValue<DeviceSnapshot> device;         ///< device → reader
  EventQueue<EventSnapshot, kEvents> events;  ///< step → reader
  EventQueue<Step, kSteps> steps;             ///< step → reader; RunnerSettings::keep_steps

  std::atomic<bool> stop{false};
  std::atomic<bool> paused{false};
  std::atomic<std::int64_t> single_steps{0};  ///< asked for so far
};

/// Distributions that a runner's loops write; others take snapshots.
struct LoopTimes {
  explicit LoopTimes(std::int64_t period_ns) : step_wall(period_ns), device_wall(period_ns) {}
  DeadlineHistogram step_cpu;
  DeadlineHistogram step_wall;
  DeadlineHistogram step_lateness;
  DeadlineHistogram device_wall;
  DeadlineHistogram device_lateness;
};

}  // namespace stylet
