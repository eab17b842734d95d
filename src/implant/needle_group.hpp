// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/implant.hpp"
#include "stylet/sim/prediction.hpp"

namespace stylet {

/// A needle of an implant with its insertion (needle_insertion()).
struct PlannedNeedle {
  const NeedleLoad* load = nullptr;
  InsertionPlan plan;
};

/// The outcome for a needle and its seeds.
struct NeedleOutcome {
  NeedleHistory needle;
  std::vector<SeedHistory> seeds;     ///< in the order of the load
  std::vector<std::string> warnings;  ///< sentences for the user
};

/// The outcome for needles that are in the tissue together.
struct GroupOutcome {
  std::vector<NeedleOutcome> needles;  ///< without the staying ones
  std::vector<NeedleHistory> staying;
  std::vector<std::string> warnings;                               ///< about the staying needles
  std::optional<Vec3> gland_at_planning_mm, gland_at_delivery_mm;  ///< as in ImplantHistory
  double compile_s = 0.0;                                          ///< wall-clock time to compile the model
};

/// Simulates needles in one tissue: the staying needles go in and stay; then all others go in, one after the other, and
/// then each of them, in the same order, drops its seeds and comes out. Catheters stay: after a pause their dwell
/// positions are seen as the images of the plan show them, and after a wait as they are at the delivery.
/// @param staying needles without seeds @param where name of the scenario in messages
/// Errors: those of Model::compile(); catheters at rest whose forces grow, since their creep is not computed well
/// enough.
Result<GroupOutcome> simulate_group(const std::vector<PlannedNeedle>& staying,
                                    const std::vector<PlannedNeedle>& needles, Scenario scenario, const TetMesh& mesh,
                                    double seed_length_mm, KnownTargets& targets, const std::string& where);

}  // namespace stylet
