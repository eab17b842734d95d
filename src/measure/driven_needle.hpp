// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fixed_work.hpp"

#include "stylet/measure/scale_bench.hpp"
#include "stylet/sim/model.hpp"

#include <vector>

namespace stylet::measure {

/// The insertion whose steps the benchmarks time: 90 mm in, back and forth by 15 mm at the deepest point, further in
/// each time, and out. A row of a benchmark reports the steps that have nearly all contacts (full_steps()).

inline constexpr double kDrivenStep_s = 1e-3;

/// Base depth [mm] after every step. @param start_mm base depth at the start
std::vector<double> driven_depths(double start_mm);

/// The default scenario in firm tissue, with the spacing that gives `contacts` contacts. In the fat of the typical
/// preset not all of 60 contacts are laid, and on coarse meshes contacts there overtake each other.
Scenario driven_scenario(int contacts);

struct DrivenStep {
  long place = 0;  ///< number of the step in two insertions of a new needle; steps of one number do the same work
  int contacts = 0;
  int iterations = 0;
  int events = 0;
  bool flagged = false;
  double cpu_us = 0.0;  ///< thread CPU time
  double wall_us = 0.0;
  double fixed_us = 0.0;  ///< thread CPU time of FixedWork directly after the step, if there is any
};

/// Simulates the insertion and times its steps.
/// @param least least number of steps; the insertion is repeated, in turn with the same needle and a new one
/// @param fixed run and timed after each step; may be null
std::vector<DrivenStep> drive_needle(const std::shared_ptr<const Model>& model, long least, const Progress& progress,
                                     const FixedWork* fixed = nullptr);

/// Indices of the steps with at least 85 % of the largest number of contacts.
std::vector<std::size_t> full_steps(const std::vector<DrivenStep>& steps);

StepTimes quantiles(std::vector<double> us);

}  // namespace stylet::measure
