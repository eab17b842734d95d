// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dose/plan_builder.hpp"
#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>

/// Words and checks that plans in JSON and in CSV have in common.
namespace stylet::detail {

Result<DosePlan> parse_plan_json(const std::filesystem::path& path);
Result<DosePlan> parse_plan_csv(const std::filesystem::path& path);

/// Sets the kind of implant from its word. Error: another word.
inline Result<> set_implant(const std::string& word, const std::string& where, DosePlan& plan) {
  if (word == "permanent" || word == "temporary") {
    plan.implant = word == "permanent" ? Implant::permanent : Implant::temporary;
    return Ok{};
  }
  return input_error(where, "the implant is '" + word + "'", "Write permanent or temporary");
}

/// Checks the numbers of a template and makes its directions unit vectors.
inline Result<> check_template(PlanTemplate& grid, const std::string& where) {
  if (!(grid.grid.pitch_mm > 0.0) || !(grid.lengths.seed_mm > 0.0) || !(grid.lengths.spacer_mm > 0.0))
    return input_error(where, "pitch and lengths of seeds and spacers must be above 0 mm", "Correct the template");
  for (Vec3* direction : {&grid.direction, &grid.left, &grid.anterior}) {
    if (!(direction->norm() > 1e-6))
      return input_error(where, "a direction of the template has no length", "Give three numbers that are not all 0");
    direction->normalize();
  }
  return Ok{};
}

}  // namespace stylet::detail
