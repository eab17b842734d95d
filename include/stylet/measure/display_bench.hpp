// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/measure/scale_bench.hpp"

#include <limits>

namespace stylet::measure {

/// What a picture of the deformed patient costs on one mesh, and how right it is.
struct DisplayRow {
  Index nodes = 0;
  std::string element;
  int surface_nodes = 0;    ///< of all organs and of the patient
  int slice_triangles = 0;  ///< most in a slice
  int zone_dofs = 0;        ///< DisplayField::Statistics
  int columns = 0;
  double stated_error_mm_per_N = 0.0;
  double prepare_s = 0.0;
  double megabytes = 0.0;
  int frames = 0;
  StepTimes surface_us;     ///< thread CPU time: forces put together, displacement and position of every surface node
  StepTimes slice_us;       ///< forces put together, cut, displacement, positions
  StepTimes both_us;        ///< surfaces and slice of the same forces
  int fine_points = 0;      ///< of the surfaces that are drawn finer along the needle's way, those of the mesh included
  StepTimes near_us;        ///< the needle's near field at these, of a display that follows the needle
  double largest_mm = 0.0;  ///< displacement of a node in any frame
  double error_mm = 0.0;    ///< largest difference of a node from K⁻¹ f by the factor
  double stated_error_mm = 0.0;  ///< largest of what was stated for the forces of a frame
  double left_out_N = 0.0;       ///< most of what fell beside the planned way
  double solve_us = 0.0;         ///< a frame by the factor instead, median
  double coarse_error_mm = std::numeric_limits<double>::quiet_NaN();  ///< … by the coarsest mesh instead
};

struct DisplayBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
};

/// The insertion of bench_scale with 40 contacts on the demo patient with 570, 5,000, 20,000 and 100,000 nodes (the
/// last of linear elements), with the surfaces and a slice shown now and then, the slice turning about the needle.
Result<std::vector<DisplayRow>> bench_display(const DisplayBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
