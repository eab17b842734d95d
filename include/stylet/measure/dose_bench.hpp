// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace stylet::measure {

/// Times of the dose rates of many sources at many points, for one formalism, on one core.
struct DoseRow {
  std::string formalism;       ///< "line2d", "line1d", "point"
  std::size_t sources = 0;     ///< number of sources
  std::size_t points = 0;      ///< number of points
  double exact_s = 0.0;        ///< [s] by the formula at each point
  double table_s = 0.0;        ///< [s] by RateTable, without making the table
  double make_table_s = 0.0;   ///< [s] for making the table
  double one_more_s = 0.0;     ///< [s] for adding one more source by the table
  double worst_percent = 0.0;  ///< largest difference of the table's sums from the formula's [%]
};

struct DoseBenchOptions {
  std::size_t sources = 100;
  std::size_t points = 1000000;
  int repeats = 3;  ///< each time is the median of so many; the formula is timed once
};

/// Times both ways to sum dose rates for seeds of model 6711 at random places of a box of 50 mm and random points in
/// it.
Result<std::vector<DoseRow>> bench_dose(const DoseBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
