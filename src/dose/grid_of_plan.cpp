// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/grid_of_plan.hpp"

#include "dose/covered_percent.hpp"

#include <fmt/format.h>

namespace stylet::dose {

namespace {

constexpr double kMostRatio = 5.0;

/// An error, or with compare_anyway a warning.
Result<> refuse(DoseEvaluation& e, const DoseGrid& grid, const std::string& what, const DoseOptions& options) {
  if (!options.compare_anyway)
    return input_error(grid.file, what, "Give the dose grid that belongs to this plan, or add --compare-anyway");
  e.warnings.push_back(fmt::format("{}: {}; it is compared nevertheless, as asked.", grid.file, what));
  return Ok{};
}

}  // namespace

Result<> check_belongs(DoseEvaluation& e, const DoseGrid& grid, std::span<const DoseStructure> structures,
                       const DoseOptions& options, const Vec3& shift_mm) {
  std::vector<std::string> reasons;
  if (!grid.frame_of_reference.empty() && !e.plan.frame_of_reference.empty() &&
      grid.frame_of_reference != e.plan.frame_of_reference)
    reasons.push_back(fmt::format("the dose grid has another frame of reference ({}) than the plan ({})",
                                  grid.frame_of_reference, e.plan.frame_of_reference));
  if (!grid.plan_uid.empty() && !e.plan.uid.empty() && grid.plan_uid != e.plan.uid)
    reasons.push_back(fmt::format("it is the dose of another plan ({}, this one is {})", grid.plan_uid, e.plan.uid));
  if (!grid.type.empty() && grid.type != "PHYSICAL")
    reasons.push_back(fmt::format("its dose type (3004,0004) is {}, PHYSICAL is expected", grid.type));
  const std::string& sum = grid.summation;
  if (!sum.empty() && sum != "PLAN" && sum != "MULTI_PLAN" && sum != "BRACHY")
    reasons.push_back(fmt::format("it holds the dose of a {} (3004,000A), that of a whole PLAN is expected", sum));
  for (const DoseStructure& structure : structures) {
    if (structure.region == "prostate" && covered_percent(structure.samples, grid, shift_mm) <= 0.0)
      reasons.push_back(fmt::format("the dose grid holds nothing of the target '{}'", structure.name));
  }
  for (const std::string& what : reasons) {
    if (Result<> told = refuse(e, grid, what, options); !told) return told;
  }
  return Ok{};
}

Result<> check_ratio(DoseEvaluation& e, const DoseGrid& grid, double ratio, const DoseOptions& options) {
  if (ratio <= kMostRatio && ratio >= 1.0 / kMostRatio) return Ok{};
  return refuse(
      e, grid,
      fmt::format("the computed dose is {:.3g} times that of the grid (median), at most {:g} times is expected", ratio,
                  kMostRatio),
      options);
}

}  // namespace stylet::dose
