// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/flush_denormals.hpp"
#include "stylet/realtime/thread_rights.hpp"

namespace stylet {

/// Keeps all pages of the process in memory while any of these that asked for it lives.
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

/// Asks for SCHED_FIFO for the calling thread and writes down the answer. @param priority 1…99, clamped to what there
/// is
void request_realtime_scheduling(int priority, ThreadRights& rights);

/// Touches the stack a loop may use, so that its pages are there; asks for exact timers.
void prepare_thread();

/// The calling thread gets processor time after ordinary ones that want it, where the system has that (Linux).
void yield_to_others();

}  // namespace stylet
