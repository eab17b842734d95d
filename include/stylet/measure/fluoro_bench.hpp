// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/measure/scale_bench.hpp"

#include <vector>

namespace stylet::measure {

/// Processor time of X-ray pictures of one mesh.
struct FluoroRow {
  Index nodes = 0;
  int pixels = 0;  ///< along a side
  int seeds = 0;   ///< seeds in the picture
  int exposures = 0;
  StepTimes cpu_us;  ///< thread CPU time of an exposure, from the moment to the grey values
};

struct FluoroBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
  int exposures = 100;    ///< of each row
};

/// Times X-ray pictures of the demo patient with 3,000 and 20,000 nodes, a needle and 100 seeds, in tissue that moves
/// from picture to picture while the C-arm stands at 35°.
Result<std::vector<FluoroRow>> bench_fluoro(const FluoroBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
