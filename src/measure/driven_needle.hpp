// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fixed_work.hpp"

#include "stylet/coupling/step_phases.hpp"
#include "stylet/measure/scale_bench.hpp"
#include "stylet/sim/model.hpp"

#include <array>
#include <vector>

namespace stylet::measure {

/// The insertion that steps are timed with: 90 mm in, back and forth by 15 mm at the deepest point, further in each
/// time, and out. Steps with nearly all contacts are what a row of a benchmark is about.

inline constexpr double kDrivenStep_s = 1e-3;

/// Depth of the base after every step, from where the insertion starts.
std::vector<double> driven_depths(double start_mm);

/// The same again and again for so long, as a motion of the base.
BaseMotion driven_motion(const PlannedInsertion& plan, double start_mm, double seconds);

/// The default scenario in firm tissue, with contacts as near each other as give so many of them. In fat of the typical
/// preset not all of sixty contacts are laid, and on coarse meshes the contacts there overtake each other.
Scenario driven_scenario(int contacts);

struct DrivenStep {
  long place = 0;  ///< in the way there and back of a needle that is new and then goes again: the same work each time
  int contacts = 0;
  int iterations = 0;
  int events = 0;
  bool flagged = false;
  double cpu_us = 0.0;  ///< of the thread
  double wall_us = 0.0;
  double fixed_us = 0.0;                       ///< processor time of FixedWork right after the step, if any
  std::array<double, kStepPhases> phase_us{};  ///< wall clock; of a run with phases
};

/// @param fixed done and timed after each step, or nothing
/// @param phases the clock is read whenever a step goes from one phase to another, which costs time itself
/// @param least steps: the way is gone again until there are so many, by the same needle and a new one by turns
std::vector<DrivenStep> drive_needle(const std::shared_ptr<const Model>& model, bool phases, long least,
                                     const Progress& progress, const FixedWork* fixed = nullptr);

/// Which of the steps have nearly all contacts.
std::vector<std::size_t> full_steps(const std::vector<DrivenStep>& steps);

StepTimes quantiles(std::vector<double> us);

}  // namespace stylet::measure
