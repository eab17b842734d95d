// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/model.hpp"

namespace stylet {

/// Largest base depth [mm] of the scenario's needle: a part of the needle stays outside, for the hand and, if
/// template.guide is set, up to the template.
double deepest_mm(const Scenario& scenario);

/// Plans an insertion in the patient of a model: entry point on the skin, direction, depth and motion. Nothing is
/// simulated. Errors: a line that misses the patient, a target beyond the needle's reach.
/// @param where name of the insertion in messages
Result<PlannedInsertion> plan_insertion(const Model& model, const InsertionPlan& plan, const std::string& where);

}  // namespace stylet
