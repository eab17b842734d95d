// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <limits>
#include <string>
#include <vector>

namespace stylet::measure {

/// Quantiles of the times of many steps [µs].
struct StepTimes {
  double p50 = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
};

/// What a step costs on one mesh with so many contacts.
struct ScaleRow {
  Index nodes = 0;
  std::string element;      ///< tissue.element
  int contacts = 0;         ///< wanted
  int contacts_max = 0;     ///< there were
  double spacing_mm = 0.0;  ///< that gave them
  long steps = 0;           ///< measured: those with at least kShare of the most contacts
  long events = 0;          ///< of the insertion in them
  long flagged = 0;         ///< of them, with a flag (Step)
  double iterations = 0.0;  ///< of the solver in a step, mean
  StepTimes cpu_us;         ///< thread CPU time
  StepTimes wall_us;
  long all_steps = 0;           ///< with however many contacts
  double all_longest_us = 0.0;  ///< of those, thread CPU time
  long all_over_1ms = 0;        ///< of those, above a millisecond of it
  double all_cpu_s = 0.0;       ///< of those together
  /// After every step an arithmetic of always the same amount is timed, 100 µs when nothing interrupts it: how often it
  /// took above a millisecond, and all of it together. An interruption takes time from it and from steps alike.
  long fixed_over_1ms = 0;
  double fixed_cpu_s = 0.0;
  /// The longest of all steps when each is given the median of its repeats, which do the same work: what is left
  /// without the system's interruptions, which count as the thread's time too. NaN with fewer than three repeats.
  double all_longest_median_us = std::numeric_limits<double>::quiet_NaN();
  /// Of the steps above a millisecond, the longest median of their repeats: whether it was the step or an interruption.
  /// NaN without such steps, or with fewer than three repeats of one.
  double over_1ms_median_us = std::numeric_limits<double>::quiet_NaN();
  double mesh_s = 0.0;     ///< from contours, wall clock
  double factor_s = 0.0;   ///< of the stiffness
  double store_s = 0.0;    ///< compliance and kernel of the corridor, and everything else before the first step
  double memory_mb = 0.0;  ///< resident in the process with the model ready
};

struct ScaleBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
  std::vector<int> contacts = {20, 40, 60};
  long steps = 0;  ///< the way is gone again until there are so many, of the same needle and of a new one by turns
};

/// How many contacts there can be: with more they would be nearer each other than the needle is thick.
int most_driven_contacts();

/// The demo patient on meshes of 570, 5,000, 20,000 and 100,000 nodes; on each the default scenario's needle goes 90 mm
/// in, back and forth by 15 mm at the deepest point, further in each time, and out, with contacts as near each other as
/// give 20, 40 and 60 of them, or as many as are asked for.
Result<std::vector<ScaleRow>> bench_scale(const ScaleBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
