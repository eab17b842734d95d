// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/evidence/validate/force_curve.hpp"

#include <string>
#include <vector>

namespace stylet::validate {

/// The demo insertion on one mesh, with one method of coupling.
struct DemoOnMesh {
  std::string method;  ///< coupling.method
  Index nodes = 0;
  double peak_N = 0.0;
  /// Root mean square difference [%] between the force curves of this mesh and of the finest mesh with the same method,
  /// relative to the peak force on the finest mesh.
  double rms_vs_finest_percent = 0.0;
  double target_shift_mm = 0.0;  ///< shift of the target's centroid at the deepest point
  double skin_mm = 0.0;          ///< depth of the base at which the skin breaks; NaN if it does not break
  double capsule_mm = 0.0;       ///< depth of the base at which the capsule breaks; NaN if it does not break
  ForceCurve curve;
};

/// Simulates the demo insertion, 70 mm in and out, on meshes of about 10,000, 2,000 and 500 nodes, with the near field
/// and with node addition.
/// @param largest meshes with more nodes are left out
/// @return of each method the finest mesh comes first
Result<std::vector<DemoOnMesh>> demo_on_meshes(Index largest = 10000, const Progress& progress = {});

}  // namespace stylet::validate
