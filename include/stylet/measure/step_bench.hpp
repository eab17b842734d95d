// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/step_phases.hpp"
#include "stylet/measure/scale_bench.hpp"

#include <array>

namespace stylet::measure {

/// The time that a step with one number of contacts spends in each phase.
struct StepRow {
  Index nodes = 0;
  int contacts = 0;                                 ///< wanted number of contacts
  int contacts_max = 0;                             ///< largest number of contacts that occurred
  long steps = 0;                                   ///< number of measured steps
  double iterations = 0.0;                          ///< mean number of solver iterations
  StepTimes cpu_us;                                 ///< thread CPU time without timing the phases
  double mean_us = 0.0;                             ///< mean of the same times
  std::array<double, kStepPhases> phase_us{};       ///< time in each StepPhase, mean of all steps
  std::array<double, kStepPhases> slow_phase_us{};  ///< the same, mean of the slowest hundredth of the steps
  double clock_share = 0.0;                         ///< relative increase of the mean step by reading the clock
};

struct StepBenchOptions {
  Index nodes = 5000;
};

/// Runs the insertion of bench_scale on one mesh with 20, 40 and 60 contacts, each eight times: in turn without and
/// with the clock read at every change of phase. StepRow::cpu_us comes from the first run
/// without the clock. All runs take identical steps.
Result<std::vector<StepRow>> bench_step(const StepBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
