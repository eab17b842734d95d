// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <array>
#include <string>
#include <vector>

namespace stylet::measure {

/// Relative errors against beam theory and computing time of one model of the needle with one number of elements.
struct NeedleRow {
  static constexpr std::array<double, 4> kTipSlopes_deg{15.0, 30.0, 45.0, 60.0};

  std::string model;
  int elements = 0;
  bool is_default = false;   ///< the number of elements the model has by default
  double small_inner = 0.0;  ///< error of the deflection under a small load at a third of the length
  double small_tip = 0.0;    ///< error of the deflection under a small load at the tip
  std::array<double, 4>
      elastica{};  ///< error of the tip's deflection under a dead tip force, for each of kTipSlopes_deg
  std::array<double, 4> shortening{};  ///< error of the tip's motion towards the base, for each of kTipSlopes_deg
  double axial_N_per_mm = 0.0;         ///< axial stiffness; infinite if the model cannot stretch
  double solve_us = 0.0;               ///< median CPU time of one linearise() and advance() with 20 loads
};

/// Measures a 200 mm needle of the default section in every model, each with several numbers of elements.
Result<std::vector<NeedleRow>> bench_needles();

}  // namespace stylet::measure
