// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/scenario_plan.hpp"

#include "dose/plan_builder.hpp"
#include "dose/plan_words.hpp"
#include "stylet/io/dose_io.hpp"

#include <fmt/format.h>

namespace stylet {

std::string name_of_plan_needle(const Scenario::ImplantPlan& plan, std::size_t number) {
  const Scenario::PlanNeedle& needle = plan.needles[number];
  return needle.hole.empty() ? fmt::format("needle {}", number + 1) : needle.hole;
}

Result<DosePlan> plan_of_scenario(const Scenario& scenario, const std::string& where) {
  const Scenario::ImplantPlan& written = scenario.plan;
  if (!written.is_given()) {
    return input_error(where, "the scenario has no plan",
                       "Name a plan of seeds in it, [plan] and below it file = \"plan.csv\", or write its needles as "
                       "[[plan.needle]]");
  }
  if (!written.file.empty()) return read_plan(written.file);
  detail::PlanBuilder builder(where);
  builder.plan.label = written.label;
  builder.plan.prescription_Gy = written.prescription_Gy;
  detail::PlanTemplate grid;
  grid.grid = scenario.grid;
  grid.lengths = {written.seed_length_mm, written.spacer_length_mm};
  const auto centre = scenario.grid.centre_mm.value_or(std::array<double, 2>{0.0, 0.0});  // only holes depend on it
  grid.origin_mm = Vec3(centre[0], centre[1], written.base_mm.value_or(0.0));
  const std::string in_template = fmt::format("{}, [template]", where);
  if (Result<> good = detail::check_template(grid, in_template); !good) return good.error();
  for (std::size_t k = 0; k < written.needles.size(); ++k) {
    const Scenario::PlanNeedle& row = written.needles[k];
    detail::PlanNeedle needle;
    needle.hole = row.hole;
    needle.name = name_of_plan_needle(written, k);
    if (row.at_mm) needle.at_mm = Vec3((*row.at_mm)[0], (*row.at_mm)[1], grid.origin_mm.z());
    needle.train = row.train;
    needle.seeds_mm = row.seeds_mm;
    needle.retraction_mm = row.retraction_mm;
    needle.strength_U = row.strength_U.value_or(written.strength_U);
    if (Result<> added = builder.add(needle, grid, fmt::format("{}, plan.needle[{}]", where, k)); !added)
      return added.error();
  }
  return builder.finish();
}

Result<std::optional<std::vector<DoseGoal>>> goals_of_scenario(const Scenario& scenario, const std::string& where) {
  const Scenario::ImplantPlan& written = scenario.plan;
  std::vector<DoseGoal> goals;
  if (!written.goals.empty()) {
    Result<std::vector<DoseGoal>> read = read_goals(written.goals);
    if (!read) return read.error();
    return std::optional(*std::move(read));
  }
  for (std::size_t k = 0; k < written.goal_table.size(); ++k) {
    const Scenario::PlanGoal& row = written.goal_table[k];
    const Result<DoseGoal> goal =
        parse_goal({row.structure, row.metric, row.bound, row.citation}, fmt::format("{}, plan.goal[{}]", where, k));
    if (!goal) return goal.error();
    goals.push_back(*goal);
  }
  if (goals.empty()) return std::optional<std::vector<DoseGoal>>();
  return std::optional(std::move(goals));
}

}  // namespace stylet
