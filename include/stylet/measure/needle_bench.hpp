// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <array>
#include <string>
#include <vector>

namespace stylet::measure {

/// One model of the needle with one number of elements: how near it comes to beam theory, and what it costs. Errors are
/// relative.
struct NeedleRow {
  static constexpr std::array<double, 4> kTipSlopes_deg{15.0, 30.0, 45.0, 60.0};

  std::string model;
  int elements = 0;
  bool is_default = false;             ///< the number of elements the model has by default
  double small_inner = 0.0;            ///< deflection under a small load at a third of the length
  double small_tip = 0.0;              ///< … at the tip
  std::array<double, 4> elastica{};    ///< tip deflection under a dead tip force, by the slope of the tip in theory
  std::array<double, 4> shortening{};  ///< how far the tip comes nearer to the base, likewise
  double axial_N_per_mm = 0.0;         ///< stiffness along the axis; infinite where the model does not stretch
  double solve_us = 0.0;               ///< thread processor time of one linearise() and advance(), 20 loads, median
};

/// A 200 mm needle of the default section in every model, with several numbers of elements.
Result<std::vector<NeedleRow>> bench_needles();

}  // namespace stylet::measure
