// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/realtime/runner.hpp"

namespace stylet::measure {

/// Result of a run of the real-time loop on this machine.
struct LoopReport {
  Index nodes = 0;
  int contacts_max = 0;
  double seconds = 0.0;  ///< wall-clock time
  double simulated_s = 0.0;
  LoopCounters counters;
  RunnerTimes times;
  ThreadRights rights;
};

struct LoopBenchOptions {
  Index nodes = 5000;
  int contacts = 40;
  double seconds = 30.0;
};

/// Runs RealtimeRunner at 1 kHz in its two threads for a wall-clock time. A scripted handle repeats the insertion of
/// bench_scale.
Result<LoopReport> bench_loop(const LoopBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
