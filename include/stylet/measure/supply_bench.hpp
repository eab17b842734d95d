// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <string>
#include <vector>

namespace stylet::measure {

/// A needle that goes where no compliance was prepared, in real time, at one speed on one mesh.
struct SupplyRow {
  Index nodes = 0;
  std::string element;  ///< tissue.element
  Index prepared = 0;   ///< nodes of the corridor
  double speed_mm_per_s = 0.0;
  long steps = 0;               ///< with the tip in tissue
  long flagged = 0;             ///< of them, where the needle had outrun the worker
  double force_off_N = 0.0;     ///< largest difference from the axial force with all compliance there
  double force_peak_N = 0.0;    ///< of that
  long rows = 0;                ///< brought by the worker …
  double rows_per_s = 0.0;      ///< … while the needle moved
  double longest_cpu_us = 0.0;  ///< of a step, thread CPU time
};

struct SupplyBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
  std::vector<double> speeds_mm_per_s = {2.0, 5.0, 10.0, 20.0, 50.0};
};

/// The demo patient on meshes of 570, 5,000, 20,000 and 100,000 nodes, its needle led parallel to the planned way,
/// outside the corridor, 40 mm deep, a step every millisecond of the clock.
Result<std::vector<SupplyRow>> bench_supply(const SupplyBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
