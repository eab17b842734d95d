// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/realtime/runner.hpp"

namespace stylet::measure {

/// What the real-time loop did on this machine.
struct LoopReport {
  Index nodes = 0;
  int contacts_max = 0;
  double seconds = 0.0;  ///< on the clock
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

/// Runs RealtimeRunner at 1 kHz in its two threads, a script at the handle: the insertion of bench_scale, again and
/// again, for so many seconds of the clock.
Result<LoopReport> bench_loop(const LoopBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
