// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/evaluate.hpp"

#include <span>

/// Whether a dose grid from a file can be that of a plan. The bounds are those of docs/how_to/dose_of_a_plan.md.
namespace stylet::dose {

/// Checks what grid and plan say, and that the grid holds a part of the target.
/// @param shift_mm [mm] added to the places of the grid's points
/// Errors: the grid cannot be that of the plan. With options.compare_anyway it is a warning of the evaluation.
Result<> check_belongs(DoseEvaluation& evaluation, const DoseGrid& grid, std::span<const DoseStructure> structures,
                       const DoseOptions& options, const Vec3& shift_mm);

/// Checks that the doses have the same order of magnitude. @param ratio median of computed dose over that of the grid
Result<> check_ratio(DoseEvaluation& evaluation, const DoseGrid& grid, double ratio, const DoseOptions& options);

}  // namespace stylet::dose
