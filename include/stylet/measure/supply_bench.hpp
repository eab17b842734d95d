// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <string>
#include <vector>

namespace stylet::measure {

/// A needle that moves in real time through tissue whose compliance was not prepared, at one speed on one mesh.
struct SupplyRow {
  Index nodes = 0;
  std::string element;  ///< tissue.element
  Index prepared = 0;   ///< nodes of the corridor, whose compliance was prepared
  double speed_mm_per_s = 0.0;
  long steps = 0;             ///< number of steps with the tip in tissue
  long flagged = 0;           ///< number of these steps for which the worker thread had not yet supplied the compliance
  double force_off_N = 0.0;   ///< largest difference from the axial force with all compliance available
  double force_peak_N = 0.0;  ///< peak of the axial force with all compliance available
  long rows = 0;              ///< rows of the compliance that the worker thread supplied
  double rows_per_s = 0.0;    ///< the same per second while the needle moved
  double longest_cpu_us = 0.0;  ///< largest thread CPU time of a step
};

struct SupplyBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
  std::vector<double> speeds_mm_per_s = {2.0, 5.0, 10.0, 20.0, 50.0};
};

/// Moves a needle into the demo patient on meshes of 570, 5,000, 20,000 and 100,000 nodes, parallel to the planned path
/// but outside the corridor, to 40 mm depth, with one step per millisecond of wall-clock time.
Result<std::vector<SupplyRow>> bench_supply(const SupplyBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
