// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/realtime/deadline_histogram.hpp"

#include <cstdint>
#include <vector>

namespace stylet::measure {

/// What viewers of a live session cost the loop.
struct ViewersReport {
  Index nodes = 0;
  int viewers = 0;
  struct Condition {
    DeadlineHistogram step_cpu;        ///< thread CPU time of steps
    std::vector<std::int64_t> p99_ns;  ///< of each turn
    std::int64_t late = 0;             ///< steps that took over more than one period
  };
  Condition without, with;
  double pictures_per_s = 0.0;  ///< that a viewer got
  double megabytes_per_s = 0.0;
};

struct ViewersBenchOptions {
  Index nodes = 5000;
  int contacts = 40;
  int viewers = 2;
  double seconds = 120.0;
};

/// Serves a live session over the loopback interface, a script at the handle: the insertion of bench_scale, again and
/// again. By turns of one insertion each, nobody watches and `viewers` do, who read everything as it comes. The times
/// are those of the steps in the session's own recording.
Result<ViewersReport> bench_viewers(const ViewersBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
