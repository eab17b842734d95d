// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"
#include "stylet/dose/swelling.hpp"

#include <span>

namespace stylet {

/// The quantity that is computed for a permanent implant. For a temporary implant it is always the total dose.
enum class DoseQuantity {
  total,         ///< dose [Gy] until the sources have decayed
  initial_rate,  ///< dose rate [Gy/h] when the sources are implanted
  until          ///< dose [Gy] within a number of days after the implantation
};

/// Choices for evaluate_dose().
struct DoseOptions {
  DoseFormalism formalism = DoseFormalism::line2d;
  DoseQuantity quantity = DoseQuantity::total;
  double days = 0.0;             ///< [d] for DoseQuantity::until, > 0
  double decay_days = 0.0;       ///< [d] from the date of the strengths to the implantation; 0: no decay in between
  double prescription_Gy = 0.0;  ///< prescribed dose [Gy]; 0: the plan's own
  double grid_step_mm = 1.0;     ///< distance of the grid's points [mm], > 0
  /// Swelling of a permanent implant. All places are those without swelling; each sample stands for its tissue, which
  /// moves with the swelling.
  Swelling swelling;
  /// Source models of the plan's further kinds of source, one for each of DosePlan::more_kinds.
  std::vector<SourceModel> more_sources;
  bool compare_anyway = false;  ///< whether compare_with_grid() warns of grids that cannot be of this plan
  bool judged = false;          ///< whether judge_plan() has judged the plan, before its sources were moved
  std::vector<DoseGoal> goals;  ///< goals to judge
  std::vector<Vec3> points;     ///< [mm] LPS, points whose dose is asked for
};

/// Factor from the sum of Tg43::rate() over PlacedSource to the quantity that is asked for, and the sources of one kind
/// with their weights: strength [U] for permanent implants, for temporary ones mean strength while the source lies
/// (mean_strength_while_decaying()) times dwell time [U h].
struct WeightedSources {
  std::vector<PlacedSource> sources;
  double factor = 1.0;
};
/// @param source model of the kind @param kind of source, 0 … kind_count(plan) − 1
WeightedSources weighted_sources(const DosePlan& plan, const SourceModel& source, const DoseOptions& options,
                                 std::size_t kind = 0);

/// Dose [Gy] of all kinds of source of an evaluated plan at points, by RateTable, without swelling.
/// @param options as given to evaluate_dose() @param points [mm] LPS
/// Errors: those of Tg43::create().
Result<std::vector<double>> doses_at(const DoseEvaluation& evaluation, const DoseOptions& options,
                                     std::span<const Vec3> points);

/// Computes the dose of a plan: at points by the formula itself, to structures and on a grid by RateTable.
/// @param structures sampled; their samples are not kept
/// Errors: no source in the plan, a prescription or option that is not positive and finite, not one model for each kind
/// of source, a rule of plan_rules.hpp that refuses, the errors of Tg43::create() and compare_source().
Result<DoseEvaluation> evaluate_dose(const DosePlan& plan, const SourceModel& source,
                                     std::span<const DoseStructure> structures, const DoseOptions& options,
                                     const Progress& progress = {});

/// Compares a dose grid from a file with the evaluated plan: the ratio of the computed dose to that of the file at all
/// points of the grid that lie further than 4 mm from each source, and whose dose is at least a tenth of the
/// prescription (without one: of the median of all points with dose) and at least 50 steps of the stored numbers, but
/// not the largest number that can be stored. It also sets how much of each structure the grid covers, with a warning
/// for organs that it does not hold.
/// @param structures the structures as given to evaluate_dose(), for their samples
/// @param shift_mm [mm] added to the places of the grid's points
/// Errors: a grid that cannot be that of the plan (another frame of reference or plan, no physical dose, a part of a
/// plan, beside the target, five times more or less dose), unless options.compare_anyway makes them warnings; no point
/// is left to compare.
Result<> compare_with_grid(DoseEvaluation& evaluation, const DoseGrid& grid, std::span<const DoseStructure> structures,
                           const DoseOptions& options, const Vec3& shift_mm = Vec3::Zero());

}  // namespace stylet
