// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"

namespace stylet::testing {

/// An invented permanent implant: 44 seeds 6711 of 0.5 U every 10 mm in an ellipsoid of 40 cc, with urethra and rectum.
/// The doses are computed by the library.
/// @param grid_mm spacing of the dose grid @param step_mm spacing of the samples of the structures
DoseEvaluation synthetic_dose(double grid_mm, double step_mm);

}  // namespace stylet::testing
