// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/measure/force_curve.hpp"

#include <string>
#include <vector>

namespace stylet::measure {

/// The quantity that is varied in a study; everything else of the insertion stays the same.
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
  /// Root mean square difference [%] between the force curves of this row and of the finest row of the same study and
  /// method, relative to the peak force of the finest row.
  double rms_vs_finest_percent = 0.0;
  double target_shift_mm = 0.0;  ///< shift of the target's centroid at the deepest point
  double skin_mm = 0.0;          ///< depth of the base at which the skin breaks; NaN if it does not break
  double capsule_mm = 0.0;       ///< depth of the base at which the capsule breaks; NaN if it does not break
  double gland_from_mm = 0.0;    ///< depth of the gland's near side on the needle's line in this mesh, from the skin
  double gland_to_mm = 0.0;      ///< depth of the gland's far side
  double surface_mean_mm = 0.0;  ///< mean distance of the mesh's gland from its contours
  double step_us = 0.0;          ///< median processor time of a step
  double offline_s = 0.0;        ///< wall-clock time until the needle can move, without meshing
  ForceCurve curve;
};

struct CouplingBenchOptions {
  Index largest = 40000;   ///< meshes with more nodes are left out
  double depth_mm = 70.0;  ///< depth of the base beyond skin contact
  bool mesh_only = false;  ///< only CouplingStudy::mesh
};

/// Simulates the demo insertion, in and out to one depth: on meshes of about 500, 2,000, 10,000 and 40,000 nodes, with
/// the near field and with node addition; with several spacings of contacts and several time steps; and with quadratic
/// elements on the two coarse meshes, to separate the excessive stiffness of linear elements from the effect of the
/// meshes' shape.
/// @return the rows; of each study and method the finest comes first
Result<std::vector<CouplingRow>> bench_coupling(const CouplingBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
