// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/prediction.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace stylet {

/// Structures that a needle should keep clear of.
enum class Spared { bone, urethra, rectum };
inline constexpr std::array<Spared, 3> kSpared{Spared::bone, Spared::urethra, Spared::rectum};
/// Name of a structure: "bone", "urethra" or "rectum".
const char* to_string(Spared structure);

/// One hole of the template whose straight way leads into the target.
struct HoleRow {
  std::string hole;          ///< "d3.5"
  double left_mm = 0.0;      ///< distance of the hole from the template's centre towards the patient's left
  double anterior_mm = 0.0;  ///< distance of the hole from the template's centre towards anterior
  double depth_mm = 0.0;     ///< depth of the tip beyond the skin, along the way
  /// Length of the way within the target, and within the urethra where it crosses the target.
  double in_target_mm = 0.0;
  /// Distance [mm] between the needle's surface and each structure of kSpared, along the whole straight way. 0: the way
  /// touches the structure or goes through it; empty: the model does not have the structure.
  std::array<std::optional<double>, kSpared.size()> clearance_mm;
  std::optional<Prediction> prediction;  ///< empty until predict_holes() has computed it
  std::string failed;                    ///< why there is no way or no prediction; empty: nothing has failed
};

/// Map of a template before the insertion: the holes from which a needle reaches the target, and the predicted effect
/// of a needle through each of them.
struct HoleMap {
  std::vector<std::string> columns;   ///< labels of the template's columns, from the patient's right to the left
  std::vector<std::string> rows;      ///< labels of the template's rows, from posterior to anterior
  double pitch_mm = 5.0;              ///< distance between neighbouring holes
  std::string planned;                ///< hole of the scenario's own insertion; may be empty
  std::vector<std::string> in_place;  ///< holes of the needles that are in place before (Model::staying())
  std::vector<HoleRow> holes;         ///< row by row from anterior to posterior, each from the patient's right to left
  int missing = 0;                    ///< number of holes whose way misses the target; they are not in `holes`
};

/// The figures of a hole by which a user chooses: with needles in place those that count from the tissue as these hold
/// it, else those that count from the tissue at rest.
struct HoleEffect {
  std::optional<Vec3> shift_at_break_mm, shift_max_mm, tip_error_mm;
};
HoleEffect effect_of(const HoleRow& row);

/// The needles in place as the prediction of the planned hole, or of the first that has one, knows them; null without
/// needles in place or without a prediction. The map must outlive the result.
const NeedlesInPlace* needles_in_place(const HoleMap& map);

/// Structures that the model does not have: no hole of the map has a clearance to them.
std::vector<Spared> missing_structures(const HoleMap& map);

/// A copy of `plan` with another hole of the template.
InsertionPlan plan_through(const InsertionPlan& plan, const std::string& hole);

/// Function that gives the plan of the needle through a hole of the template.
using PlanOfHole = std::function<InsertionPlan(const std::string& hole)>;

/// Computes the straight ways through all holes of a model's template and their clearances, without any insertion. A
/// way begins at the skin and has the depth of its plan, or ends at the far end of the target if the plan has no depth.
/// @param where name of the scenario in messages
/// Errors: a model without a target; no hole leads into the target.
Result<HoleMap> map_ways(const Model& model, const PlanOfHole& plan_of, const std::string& where);

/// Simulates the insertion of a needle through one hole: compiles a model for the plan and drives the needle in. The
/// results equal the results of run() for the scenario with this plan.
/// @param scenario the scenario; its insertions are replaced by `plan`
/// @param mesh mesh of the scenario's patient
/// @param targets cache for this scenario and mesh
/// @param progress may throw to cancel
/// @param own parts that replace the scenario's needle model or law of cutting
Result<Prediction> predict_hole(Scenario scenario, const TetMesh& mesh, const InsertionPlan& plan,
                                KnownTargets& targets, const Progress& progress = {}, const OwnParts& own = {});

/// Fills in the prediction of each row of the map by predict_hole(), several holes in parallel. If one fails, its row
/// says why (HoleRow::failed).
/// @param model the model from which map_ways() made the map
/// @param progress is called in the caller's thread
void predict_holes(const std::shared_ptr<const Model>& model, const PlanOfHole& plan_of, HoleMap& map,
                   const Progress& progress = {});

/// Checks that a map can be made for a scenario: it must plan exactly one needle, through a hole of the template,
/// without a recorded motion. The error names the key that prevents it.
/// @param where name of the scenario in messages
Result<> check_mappable(const Scenario& scenario, const std::string& where);

}  // namespace stylet
