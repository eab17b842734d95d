// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/flush_denormals.hpp"
#include "stylet/realtime/thread_rights.hpp"

namespace stylet {

/// Keeps all pages of the process in memory as long as an object with wanted = true exists.
class LockedMemory {
 public:
  explicit LockedMemory(bool wanted);
  ~LockedMemory();
  LockedMemory(const LockedMemory&) = delete;
  LockedMemory& operator=(const LockedMemory&) = delete;

  [[nodiscard]] int error() const { return error_; }  ///< errno of the refusal
  [[nodiscard]] bool locked() const { return held_; }

 private:
  bool held_ = false;
  int error_ = 0;
};

/// Requests SCHED_FIFO for the calling thread and records the result. @param priority 1…99, clamped to the system's
/// range
void request_realtime_scheduling(int priority, ThreadRights& rights);

/// Prepares the calling thread for a real-time loop: touches the stack that the loop may use, so that its pages are
/// mapped, and requests exact timers.
void prepare_thread();

/// Lowers the priority of the calling thread below ordinary threads, if the system supports it (Linux).
void yield_to_others();

}  // namespace stylet
