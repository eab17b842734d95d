// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/base_follower.hpp"
#include "stylet/realtime/deadline_histogram.hpp"
#include "stylet/realtime/force_guard.hpp"
#include "stylet/realtime/steppable.hpp"
#include "stylet/realtime/thread_rights.hpp"

#include <memory>
#include <optional>
#include <span>

namespace stylet {

struct RunnerSettings {
  double period_s = 1e-3;      ///< 0.05 ms … 0.1 s
  int max_catch_up = 4;        ///< a step stands for at most so many periods (PeriodGrid)
  double late_after_s = 5e-3;  ///< older results and samples are not used; at least two periods
  BaseFollower::Limits limits;
  ForceGuardSettings guard;
  /// Without: the base is where the handle is, and the hand feels the force on the base itself.
  std::optional<VirtualCouplingSettings> coupling;
  bool realtime_scheduling = true;  ///< asked for; ThreadRights tells what was granted
  int priority = 80;                ///< of SCHED_FIFO, 1…98; the device's thread has one more
  bool keep_steps = false;          ///< every step is kept for take_steps()
  bool lock_memory = true;          ///< asked for, for the whole process while the runner runs
};

/// How long things took, since the runner was made. Misses count durations over a period.
struct RunnerTimes {
  DeadlineHistogram step_cpu;         ///< thread CPU time of Steppable::step
  DeadlineHistogram step_wall;        ///< the same on the wall
  DeadlineHistogram step_lateness;    ///< wake-up of the step's thread after it was due
  DeadlineHistogram device_wall;      ///< a turn of the device's thread
  DeadlineHistogram device_lateness;  ///< wake-up of the device's thread
};

/// Runs a simulation against a device in real time, in two threads with one clock. The device's thread reads the
/// handle, computes the coupling's force, guards it and sends it, every period, whatever the simulation does; the
/// step's thread moves the base and takes a step. They pass each other values without waiting, so a step that hangs
/// cannot keep an old force at the hand. docs/realtime.md has the whole picture.
///
/// start() and stop() belong to one controlling thread; fetch…() and take_events() to one reading thread (it may be the
/// same); pause(), resume() and single_step() to any, wait-free. A handle follows only from start() on.
class RealtimeRunner {
 public:
  /// Refuses settings out of range, and a coupling that the device cannot bear (VirtualCoupling::create).
  static Result<std::unique_ptr<RealtimeRunner>> create(std::unique_ptr<Steppable> body, std::unique_ptr<Device> device,
                                                        const RunnerSettings& settings);
  ~RealtimeRunner();  ///< stops
  RealtimeRunner(const RealtimeRunner&) = delete;
  RealtimeRunner& operator=(const RealtimeRunner&) = delete;

  /// Starts both threads. An error only when there is no thread to be had; rights not granted are no error.
  Result<> start();
  /// Fades the force, ends both threads and waits for them; a step under way is finished first. The device is left with
  /// no force. start() may follow.
  void stop();
  [[nodiscard]] bool running() const;

  void pause();   ///< after the step under way; the force fades
  void resume();  ///< time spent in pause does not count
  /// While paused: takes this many steps of one period.
  void single_step(int count = 1);

  /// Fetches the newest picture of the simulation. @return whether it is a new one
  bool fetch_snapshot();
  [[nodiscard]] const Snapshot& snapshot() const;  ///< the one fetched last
  bool fetch_device();
  [[nodiscard]] const DeviceSnapshot& device_snapshot() const;
  /// Takes the oldest events not yet taken. @return how many
  std::size_t take_events(std::span<EventSnapshot> out);

  /// With keep_steps: takes the oldest steps not yet taken. Room is for four thousand; what comes beyond is dropped and
  /// counted (LoopCounters::dropped_steps). @return how many
  std::size_t take_steps(std::span<Step> out);

  /// Any thread, any time; about 95 kB.
  [[nodiscard]] std::unique_ptr<RunnerTimes> times() const;
  /// What the last start() was granted.
  [[nodiscard]] const ThreadRights& rights() const;
  [[nodiscard]] const RunnerSettings& settings() const;

  /// The simulation, while the runner does not run.
  [[nodiscard]] Steppable& body();

 private:
  struct Parts;
  explicit RealtimeRunner(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
