// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace stylet {

/// Rights that the operating system has granted to a loop. The loop runs without them, but other programs can then
/// delay it. docs/realtime.md explains how to permit them.
struct ThreadRights {
  bool realtime_scheduling = false;  ///< SCHED_FIFO: runs before all ordinary threads
  int priority = 0;                  ///< priority of SCHED_FIFO, 1…99
  int scheduling_error = 0;          ///< errno of the refusal; 0 = granted or not requested
  bool memory_locked = false;        ///< no page of the process is swapped to disk
  int memory_error = 0;              ///< errno of the refusal; 0 = granted or not requested
  bool denormals_flushed = false;    ///< denormal numbers (below 2.2e-308) are treated as 0 and cost no time

  /// The rights in one sentence for the user.
  [[nodiscard]] std::string describe() const;
};

}  // namespace stylet
