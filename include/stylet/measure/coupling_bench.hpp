// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/measure/force_curve.hpp"

#include <string>
#include <vector>

namespace stylet::measure {

/// What is varied while everything else of the insertion stays.
enum class CouplingStudy { mesh, geometry, spacing, time_step };
const char* to_string(CouplingStudy study);  ///< "mesh", "geometry", "spacing", "dt"

/// One insertion into the demo patient.
struct CouplingRow {
  CouplingStudy study{};
  std::string method;   ///< coupling.method
  std::string element;  ///< tissue.element
  Index nodes = 0;
  double spacing_mm = 0.0;
  double dt_ms = 0.0;
  double peak_N = 0.0;
  double rms_vs_finest_percent = 0.0;  ///< of the finest's peak; the finest of the same study and method
  double target_shift_mm = 0.0;        ///< of the target's centroid at the deepest point
  double skin_mm = 0.0;                ///< depth of the base at which the skin breaks; NaN where it does not
  double capsule_mm = 0.0;             ///< … and the capsule
  double gland_from_mm = 0.0;    ///< where on the needle's line this mesh has the gland's near side, from the skin
  double gland_to_mm = 0.0;      ///< … and its far side
  double surface_mean_mm = 0.0;  ///< how far the mesh's gland is from its contours
  double step_us = 0.0;          ///< processor time of a step, median
  double offline_s = 0.0;        ///< until the needle can move, the mesh not counted; wall clock
  ForceCurve curve;
};

struct CouplingBenchOptions {
  Index largest = 40000;   ///< meshes with more nodes are left out
  double depth_mm = 70.0;  ///< of the base beyond skin contact
  bool mesh_only = false;  ///< only the study of meshes
};

/// The demo insertion, in and out to one depth, on meshes of about 500, 2,000, 10,000 and 40,000 nodes with the near
/// field and with node addition; over the spacing of contacts and over the time step; and with quadratic elements on
/// the two coarse meshes, which tells what linear ones resist too much from what the meshes' shape does.
/// @return the finest of each study and method first
Result<std::vector<CouplingRow>> bench_coupling(const CouplingBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
