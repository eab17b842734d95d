// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/measure/scale_bench.hpp"

#include <vector>

namespace stylet::measure {

/// The time of a step while other needles rest in the tissue.
struct TogetherRow {
  int at_rest = 0;          ///< number of needles at rest
  int contacts = 0;         ///< contacts of the moving needle at its deepest
  int contacts_in_all = 0;  ///< contacts of all needles
  long steps = 0;           ///< number of timed steps
  long flagged = 0;         ///< of these, steps without a balance
  double iterations = 0.0;  ///< mean number of solver iterations
  StepTimes cpu_us;         ///< thread CPU time of a step
};

struct TogetherBenchOptions {
  Index nodes = 3000;
  int needles = 10;  ///< largest number of needles at rest, 1 … kMostAtRest
};
inline constexpr int kMostAtRest = 20;

/// Puts needles into the demo patient one after the other, through holes of the template about the middle of the gland,
/// where they stay. The steps of some of them are timed from a depth of 40 mm to one of 85 mm, at 20 mm/s in steps of
/// 1 ms.
Result<std::vector<TogetherRow>> bench_together(const TogetherBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
