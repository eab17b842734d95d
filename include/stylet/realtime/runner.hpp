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
  int max_catch_up = 4;        ///< largest number of periods that a step may stand for (PeriodGrid)
  double late_after_s = 5e-3;  ///< results and samples older than this are not used; at least two periods
  BaseFollower::Limits limits;
  ForceGuardSettings guard;
  /// Without a coupling the base follows the handle exactly, and the hand feels the force on the base directly.
  std::optional<VirtualCouplingSettings> coupling;
  bool realtime_scheduling = true;  ///< request real-time scheduling; ThreadRights says whether it was granted
  int priority = 80;                ///< priority of SCHED_FIFO, 1…98; that of the device's thread is higher by 1
  bool keep_steps = false;          ///< keep every step for take_steps()
  bool lock_memory = true;          ///< request to lock the memory of the whole process while the runner runs
};

/// Durations since the runner was created. Misses are durations longer than a period.
struct RunnerTimes {
  DeadlineHistogram step_cpu;         ///< thread CPU time of Steppable::step()
  DeadlineHistogram step_wall;        ///< wall-clock time of Steppable::step()
  DeadlineHistogram step_lateness;    ///< delay of the step thread's wake-up after it was due
  DeadlineHistogram device_wall;      ///< wall-clock time of a turn of the device's thread
  DeadlineHistogram device_lateness;  ///< delay of the device thread's wake-up after it was due
};

/// Runs a simulation with a device in real time, in two threads with one clock. In every period, whatever the
/// simulation does, the device's thread reads the handle, computes the coupling's force, makes it safe (ForceGuard) and
/// sends it; the step's thread moves the base and takes a step. The threads exchange values wait-free, so a step that
/// hangs cannot leave an old force at the hand. Details: docs/realtime.md.
///
/// Call start() and stop() from one controlling thread, fetch…() and take_…() from one reading thread (which may be the
/// same), and pause(), resume() and single_step(), which are wait-free, from any thread.
class RealtimeRunner {
 public:
  /// Errors: settings out of range, and a coupling that is not passive with this device (VirtualCoupling::create()).
  static Result<std::unique_ptr<RealtimeRunner>> create(std::unique_ptr<Steppable> body, std::unique_ptr<Device> device,
                                                        const RunnerSettings& settings);
  ~RealtimeRunner();  ///< calls stop()
  RealtimeRunner(const RealtimeRunner&) = delete;
  RealtimeRunner& operator=(const RealtimeRunner&) = delete;

  /// Starts both threads. Errors: it is already running; the system provides no thread. Rights that are not granted are
  /// not an error.
  Result<> start();
  /// Fades the force to zero, ends both threads and waits for them; a step in progress is finished first. start() may
  /// be called again afterwards.
  void stop();
  [[nodiscard]] bool running() const;

  void pause();   ///< pauses after the step in progress; the force fades to zero
  void resume();  ///< continues; the time of the pause does not count as simulated time
  /// Takes `count` steps of one period each while paused; without effect otherwise.
  void single_step(int count = 1);

  /// Fetches the newest snapshot of the simulation. @return whether it is a new one
  bool fetch_snapshot();
  [[nodiscard]] const Snapshot& snapshot() const;  ///< the snapshot fetched last
  /// Fetches the newest snapshot of the device. @return whether it is a new one
  bool fetch_device();
  [[nodiscard]] const DeviceSnapshot& device_snapshot() const;  ///< the device snapshot fetched last
  /// Takes the oldest events from the queue. @return number of events written
  std::size_t take_events(std::span<EventSnapshot> out);

  /// Takes the oldest steps from the queue, with RunnerSettings::keep_steps. The queue has room for 4096 steps; if it
  /// is full, further ones are dropped and counted (LoopCounters::dropped_steps). @return number of steps written
  std::size_t take_steps(std::span<Step> out);

  /// A copy of the histograms (about 95 kB). May be called from any thread at any time.
  [[nodiscard]] std::unique_ptr<RunnerTimes> times() const;
  /// The rights that the last start() was granted.
  [[nodiscard]] const ThreadRights& rights() const;
  [[nodiscard]] const RunnerSettings& settings() const;

  /// The simulation; must not be used while the runner is running.
  [[nodiscard]] Steppable& body();

 private:
  struct Parts;
  explicit RealtimeRunner(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
