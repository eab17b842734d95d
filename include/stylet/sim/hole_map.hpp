// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/prediction.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace stylet {

/// Structures that a needle is to keep clear of.
enum class Spared { bone, urethra, rectum };
inline constexpr std::array<Spared, 3> kSpared{Spared::bone, Spared::urethra, Spared::rectum};
/// "bone", "urethra", "rectum".
const char* to_string(Spared structure);

/// One hole of the template, whose straight way leads into the target.
struct HoleRow {
  std::string hole;           ///< "d3.5"
  double left_mm = 0.0;       ///< from the template's centre towards the patient's left
  double anterior_mm = 0.0;   ///< from the template's centre towards anterior
  double depth_mm = 0.0;      ///< of the tip beyond the skin, along the way
  double in_target_mm = 0.0;  ///< length of the way in the target, and in the urethra where that runs through it
  /// Distance between the needle's surface and each structure of kSpared, along the whole straight way [mm]; 0 where
  /// the way touches the structure or goes through it; empty where the model does not have the structure.
  std::array<std::optional<double>, kSpared.size()> clearance_mm;
  std::optional<Prediction> prediction;  ///< empty until there is one
  std::string failed;                    ///< why there can be no way or no prediction; empty: nothing has failed
};

/// The map before a needle goes in: the holes of a template from which a needle reaches the target, and what it
/// would do there.
struct HoleMap {
  std::vector<std::string> columns;  ///< of the template, from the patient's right to the left
  std::vector<std::string> rows;     ///< of the template, from posterior to anterior
  double pitch_mm = 5.0;             ///< between neighbouring holes
  std::string planned;               ///< hole that the scenario plans; may be empty
  std::vector<HoleRow> holes;        ///< as one looks at the template: from anterior to posterior, right to left
  int missing = 0;                   ///< holes of the template whose way misses the target; they are not in `holes`
};

/// Structures that the model does not have, so that no hole has a clearance to them.
std::vector<Spared> missing_structures(const HoleMap& map);

/// The plan of a needle through another hole, otherwise as `plan` has it.
InsertionPlan plan_through(const InsertionPlan& plan, const std::string& hole);

/// The plan of a needle for each hole of the template.
using PlanOfHole = std::function<InsertionPlan(const std::string& hole)>;

/// The straight ways through all holes of a model's template, with their clearances; nothing is inserted. A way begins
/// at the skin and is as long as its plan says, or else leads to the far end of the target.
/// @param where what to call the scenario in messages
/// Errors: a model without a target, a target that no hole leads to.
Result<HoleMap> map_ways(const Model& model, const PlanOfHole& plan_of, const std::string& where);

/// Inserts a needle through one hole: its model is compiled and the needle driven in, so that the figures are those
/// that a scenario with this plan gives.
/// @param scenario whose insertions the plan replaces @param mesh of its patient
/// @param targets of this scenario and mesh
/// @param own parts that replace those of the scenario
/// @param progress may throw, to give up
Result<Prediction> predict_hole(Scenario scenario, const TetMesh& mesh, const InsertionPlan& plan,
                                KnownTargets& targets, const Progress& progress = {}, const OwnParts& own = {});

/// Inserts a needle through each of the map's holes, several at a time. An insertion that fails is said in its row.
/// @param model whose patient and scenario the needles are for
/// @param progress is called in the caller's thread
void predict_holes(const std::shared_ptr<const Model>& model, const PlanOfHole& plan_of, HoleMap& map,
                   const Progress& progress = {});

/// The reason why a scenario can have no map, as an input error that names the key: it has to plan exactly one needle,
/// through a hole of the template, and no recorded motion.
/// @param where what to call the scenario in messages
Result<> check_mappable(const Scenario& scenario, const std::string& where);

}  // namespace stylet
