// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/step_phases.hpp"
#include "stylet/measure/scale_bench.hpp"

#include <array>

namespace stylet::measure {

/// On what a step with so many contacts spends its time.
struct StepRow {
  Index nodes = 0;
  int contacts = 0;      ///< wanted
  int contacts_max = 0;  ///< there were
  long steps = 0;        ///< measured
  double iterations = 0.0;
  StepTimes cpu_us;                                 ///< thread CPU time, nobody observing the phases
  double mean_us = 0.0;                             ///< of the same
  std::array<double, kStepPhases> phase_us{};       ///< mean of all steps (StepPhase)
  std::array<double, kStepPhases> slow_phase_us{};  ///< mean of the slowest hundredth
  double clock_share = 0.0;                         ///< by which reading the clock makes the mean step longer
};

struct StepBenchOptions {
  Index nodes = 5000;
};

/// The insertion of bench_scale on one mesh, with 20, 40 and 60 contacts, each eight times: by turns as it is and with
/// the clock read at every change of phase. The first is that of the times of steps. All runs take the very same steps.
Result<std::vector<StepRow>> bench_step(const StepBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
