// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/measure/scale_bench.hpp"

#include <limits>

namespace stylet::measure {

/// Computing time and error of a picture of the deformed patient on one mesh.
struct DisplayRow {
  Index nodes = 0;
  std::string element;
  int surface_nodes = 0;    ///< nodes on the surfaces of all organs and of the patient
  int slice_triangles = 0;  ///< largest number of triangles in a slice
  int zone_dofs = 0;        ///< this and the next four fields: DisplayField::Statistics
  int columns = 0;
  double stated_error_mm_per_N = 0.0;
  double prepare_s = 0.0;
  double megabytes = 0.0;
  int frames = 0;
  StepTimes surface_us;     ///< thread CPU time: forces assembled, displacement and position of every surface node
  StepTimes slice_us;       ///< thread CPU time: forces assembled, slice cut, displacement and positions of its points
  StepTimes both_us;        ///< thread CPU time: surfaces and slice of the same forces
  int fine_points = 0;      ///< points of the surfaces refined along the needle's way, mesh nodes included
  StepTimes near_us;        ///< thread CPU time: the needle's near field at fine_points
  double largest_mm = 0.0;  ///< largest displacement of a node in any frame
  double error_mm = 0.0;    ///< largest difference of a node from the exact solution K⁻¹ f
  double stated_error_mm = 0.0;  ///< largest error that the field states for the forces of a frame
  double left_out_N = 0.0;       ///< largest force that was left out because it acts beside the planned path
  double solve_us = 0.0;         ///< median CPU time of a frame computed with the factor of K instead
  /// Largest error of a node if the displacement is computed on the coarsest mesh and interpolated; NaN for that mesh.
  double coarse_error_mm = std::numeric_limits<double>::quiet_NaN();
};

struct DisplayBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
};

/// Simulates the insertion of bench_scale with 40 contacts on the demo patient with 570, 5,000, 20,000 and 100,000
/// nodes (the last with linear elements). At regular times the surfaces and a slice, which turns about the needle, are
/// computed.
Result<std::vector<DisplayRow>> bench_display(const DisplayBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
