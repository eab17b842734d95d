// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "event_queue.hpp"
#include "stylet/realtime/deadline_histogram.hpp"
#include "stylet/realtime/device.hpp"
#include "stylet/realtime/latest_value.hpp"
#include "stylet/realtime/snapshot.hpp"

#include <atomic>

namespace stylet {

/// The result of a step that the device's thread needs.
struct StepResult {
  PlainPose base;
  Triple velocity{};          ///< [mm/s] LPS, of the base
  Triple angular_velocity{};  ///< [rad/s]
  PlainWrench hand;           ///< force and torque that the hand exerts on the base
  double clock_s = -1e300;    ///< end of the step on the runner's clock
  double simulated_s = 0.0;
  bool good = false;  ///< the step is trusted, and the simulation is not paused
};

/// All data that the threads of a runner exchange, wait-free. Each item has one writer and one reader; the commands at
/// the end may have any number of writers.
struct Exchange {
  static constexpr std::size_t kEvents = 1024;
  static constexpr std::size_t kSteps = 4096;

  LatestValue<DeviceInput> input;             ///< device → step
  LatestValue<StepResult> result;             ///< step → device
  LatestValue<Snapshot> snapshot;             ///< step → reader
  LatestValue<DeviceSnapshot> device;         ///< device → reader
  EventQueue<EventSnapshot, kEvents> events;  ///< step → reader
  EventQueue<Step, kSteps> steps;             ///< step → reader, with RunnerSettings::keep_steps

  std::atomic<bool> stop{false};
  std::atomic<bool> paused{false};
  std::atomic<std::int64_t> single_steps{0};  ///< number of single steps requested since the runner was created
};

/// Histograms that a runner's loops write; other threads read them with snapshot().
struct LoopTimes {
  explicit LoopTimes(std::int64_t period_ns) : step_wall(period_ns), device_wall(period_ns) {}
  DeadlineHistogram step_cpu;
  DeadlineHistogram step_wall;
  DeadlineHistogram step_lateness;
  DeadlineHistogram device_wall;
  DeadlineHistogram device_lateness;
};

}  // namespace stylet
