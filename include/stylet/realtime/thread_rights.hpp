// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace stylet {

/// What the operating system granted a loop. Nothing here is needed to run; without it other programs can make the loop
/// late. docs/realtime.md tells how to permit it.
struct ThreadRights {
  bool realtime_scheduling = false;  ///< SCHED_FIFO: runs before all ordinary threads
  int priority = 0;                  ///< of SCHED_FIFO, 1…99
  int scheduling_error = 0;          ///< errno of the refusal, 0 = granted or not asked for
  bool memory_locked = false;        ///< no page of the process is ever fetched from disk
  int memory_error = 0;              ///< errno of the refusal, 0 = granted or not asked for
  bool denormals_flushed = false;    ///< numbers below 1e-308 are 0 and cost no time

  /// One sentence for people.
  [[nodiscard]] std::string describe() const;
};

}  // namespace stylet
