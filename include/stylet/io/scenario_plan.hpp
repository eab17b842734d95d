// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/dose/dose_plan.hpp"
#include "stylet/dose/goals.hpp"
#include "stylet/sim/scenario.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// The plan of a scenario: that of its file (read_plan()), or that of its needles ([[plan.needle]]), which is the plan
/// that the same needles have as CSV. A plan of needles has the scenario's name as its file.
/// @param scenario checked by check_scenario(); paths in it are relative to the current folder
/// @param where name of the scenario in messages
/// Errors: no plan; those of read_plan(); a malformed train; a strength that is missing; a place out of reach.
Result<DosePlan> plan_of_scenario(const Scenario& scenario, const std::string& where);

/// The name of a needle of a scenario's plan, by which its seeds know it: its hole, or "needle 3".
std::string name_of_plan_needle(const Scenario::ImplantPlan& plan, std::size_t number);

/// The goals of a scenario: those of its file (read_goals()), or those of its tables ([[plan.goal]]); empty where the
/// scenario has neither. Errors: those of read_goals() and of parse_goal(). @param where as above
Result<std::optional<std::vector<DoseGoal>>> goals_of_scenario(const Scenario& scenario, const std::string& where);

}  // namespace stylet
