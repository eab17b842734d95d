// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <limits>
#include <string>
#include <vector>

namespace stylet::measure {

/// Quantiles of the computing times of steps [µs].
struct StepTimes {
  double p50 = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
};

/// Computing time of a step on one mesh with one number of contacts.
struct ScaleRow {
  Index nodes = 0;
  std::string element;          ///< tissue.element
  int contacts = 0;             ///< wanted number of contacts
  int contacts_max = 0;         ///< largest number of contacts that occurred
  double spacing_mm = 0.0;      ///< spacing of contacts that gives the wanted number
  long steps = 0;               ///< number of measured steps: those with at least 85 % of contacts_max
  long events = 0;              ///< events of the insertion in the measured steps
  long flagged = 0;             ///< measured steps with a flag (Step::flags)
  double iterations = 0.0;      ///< mean number of solver iterations in a measured step
  StepTimes cpu_us;             ///< thread CPU time of the measured steps
  StepTimes wall_us;            ///< wall-clock time of the measured steps
  long all_steps = 0;           ///< number of all steps, with any number of contacts
  double all_longest_us = 0.0;  ///< largest thread CPU time of all steps
  long all_over_1ms = 0;        ///< number of all steps with more than 1 ms of thread CPU time
  double all_cpu_s = 0.0;       ///< sum of the thread CPU times of all steps
  /// After every step a fixed amount of arithmetic is timed, which takes 100 µs if nothing interrupts it. These members
  /// are the number of times that it took more than 1 ms, and the sum of its times. Interruptions by the system
  /// lengthen this arithmetic and the steps alike.
  long fixed_over_1ms = 0;
  double fixed_cpu_s = 0.0;
  /// Largest value of the median time of each step over its repeats, which do the same work. The median removes the
  /// system's interruptions, which count as thread CPU time too. NaN with fewer than three repeats.
  double all_longest_median_us = std::numeric_limits<double>::quiet_NaN();
  /// The same for the steps that took more than 1 ms: it tells whether the step itself or an interruption was long.
  /// NaN without such steps, or if one has fewer than three repeats.
  double over_1ms_median_us = std::numeric_limits<double>::quiet_NaN();
  double mesh_s = 0.0;     ///< wall-clock time of meshing the contours
  double factor_s = 0.0;   ///< time of factorising the stiffness
  double store_s = 0.0;    ///< time of the corridor's compliance and kernel, and all else before the first step
  double memory_mb = 0.0;  ///< resident memory of the process with the model ready
};

struct ScaleBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
  std::vector<int> contacts = {20, 40, 60};
  long steps = 0;  ///< least number of steps: the insertion is repeated, in turn with the same needle and a new one
};

/// Largest number of contacts. With more, their spacing would be smaller than the needle's diameter.
int most_driven_contacts();

/// Times the steps of an insertion into the demo patient on meshes of 570, 5,000, 20,000 and 100,000 nodes. The needle
/// of the default scenario goes 90 mm in, back and forth by 15 mm at the deepest point, further in each time, and out.
/// The spacing of contacts is chosen to give 20, 40 and 60 of them, or the numbers in ScaleBenchOptions::contacts.
Result<std::vector<ScaleRow>> bench_scale(const ScaleBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
