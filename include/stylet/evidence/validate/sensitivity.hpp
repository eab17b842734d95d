// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"

#include <string>
#include <vector>

namespace stylet::validate {

/// What a run comes to, as the study compares it.
struct Outputs {
  double peak_axial_N = 0.0;
  double target_shift_mm = 0.0;    ///< of the target's centroid, at the deepest point
  double tip_deflection_mm = 0.0;  ///< largest distance of the tip from the straight line
};

/// A parameter moved down and up.
struct Influence {
  std::string key;      ///< of the scenario: "tissue.prostate.young_kPa"
  std::string meaning;  ///< for people: "prostate: Young’s modulus"
  std::string unit;
  std::string base;  ///< values in words; of a choice the word
  std::string low;
  std::string high;  ///< empty where there is one other choice only
  Outputs at_low;
  Outputs at_high;
  std::string note;  ///< "limited to 0.49", an error of a run, …
};

/// How the outputs of the demo insertion move with each parameter.
struct Sensitivity {
  double change = 0.2;  ///< relative change of each parameter
  std::string scenario;
  Outputs base;
  std::vector<Influence> influences;
  int threads = 1;
  double seconds = 0.0;  ///< wall clock
};

/// The study as lines of a table, the first its head: key, values, change of each output; the most influential
/// parameter first.
std::vector<std::vector<std::string>> sensitivity_lines(const Sensitivity& study);

/// Runs the demo once as it is and twice for each parameter, on as many threads as there are cores.
/// @param quick fewer parameters, a coarser mesh and a shorter insertion: for trying out
Result<Sensitivity> measure_sensitivity(bool quick, const Progress& progress = {});

}  // namespace stylet::validate
