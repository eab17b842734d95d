// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/model.hpp"

namespace stylet {

/// Largest depth [mm] of the base: what is left of the needle outside is held by the hand, and by the template if that
/// guides it.
double deepest_mm(const Scenario& scenario);

/// What an insertion would be in the patient of a model, without computing anything for it: where it meets the skin and
/// how deep it goes. Errors: a line that misses the patient, a target out of the needle's reach.
/// @param where what to call it in messages
Result<PlannedInsertion> plan_insertion(const Model& model, const InsertionPlan& plan, const std::string& where);

}  // namespace stylet
