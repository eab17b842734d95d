// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/realtime/deadline_histogram.hpp"

#include <cstdint>
#include <vector>

namespace stylet::measure {

/// The effect of viewers of a live session, or of pictures made beside it, on the real-time loop.
struct ViewersReport {
  Index nodes = 0;
  int viewers = 0;
  struct Condition {
    DeadlineHistogram step_cpu;        ///< thread CPU time of steps
    std::vector<std::int64_t> p99_ns;  ///< 99 % quantile of this time in each turn
    std::int64_t late = 0;             ///< steps that covered more than one period, because the loop was late
  };
  Condition without, with;
  double pictures_per_s = 0.0;    ///< pictures that one viewer received per second
  double megabytes_per_s = 0.0;   ///< data that one viewer received per second
  double ultrasound_per_s = 0.0;  ///< ultrasound pictures that were made per second

  /// Median over the turns of p99 with viewers or pictures, over the median without.
  [[nodiscard]] double p99_ratio() const;
};

struct ViewersBenchOptions {
  Index nodes = 5000;
  int contacts = 40;
  int viewers = 2;
  bool ultrasound = false;  ///< instead of viewers, a companion gets ultrasound pictures with a probe that presses
  double seconds = 120.0;
};

/// Serves a live session over the loopback interface; a scripted handle repeats the insertion of bench_scale. In turns
/// of one insertion each there are no viewers, or `viewers` that read everything at once; or there are no ultrasound
/// pictures, or as many as the session makes. The times of steps come from the session's recording.
Result<ViewersReport> bench_viewers(const ViewersBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
