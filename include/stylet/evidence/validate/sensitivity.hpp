// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"

#include <string>
#include <vector>

namespace stylet::validate {

/// The results of a run that the study compares.
struct Outputs {
  double peak_axial_N = 0.0;
  double target_shift_mm = 0.0;    ///< shift of the target's centroid at the deepest point
  double tip_deflection_mm = 0.0;  ///< largest distance of the tip from the straight line
};

/// The influence of one parameter, which is decreased and increased, or of one choice, which is replaced.
struct Influence {
  std::string key;      ///< key of the scenario: "tissue.prostate.young_kPa"
  std::string meaning;  ///< in words: "prostate: Young’s modulus"
  std::string unit;
  std::string base;  ///< base value as text; for a choice its word
  std::string low;   ///< decreased value, or the other choice
  std::string high;  ///< increased value; empty for a choice
  Outputs at_low;
  Outputs at_high;
  std::string note;  ///< a remark such as "limited to 0.49", or the error of a run
};

/// The change of the demo insertion's outputs with each parameter.
struct Sensitivity {
  double change = 0.2;  ///< relative change of each parameter
  std::string scenario;
  Outputs base;
  std::vector<Influence> influences;
  int threads = 1;
  double seconds = 0.0;  ///< wall clock
};

/// The study as rows of a table. The first row is the head: key, values, change of each output. The most influential
/// parameter comes first.
std::vector<std::vector<std::string>> sensitivity_lines(const Sensitivity& study);

/// Runs the demo once with the base values and twice for each parameter, with one thread per core.
/// @param quick fewer parameters, a coarser mesh and a shorter insertion, for a first try
Result<Sensitivity> measure_sensitivity(bool quick, const Progress& progress = {});

}  // namespace stylet::validate
