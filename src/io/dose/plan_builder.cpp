// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/plan_builder.hpp"

#include "detail/reach.hpp"
#include "stylet/dose/strength_age.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stylet::detail {

namespace {

constexpr double kStrongestSeed_U = 1000.0;  // seeds have 0.2 to 10 U; above this the number has another unit
constexpr double kSamePoint_mm = 0.01;

}  // namespace

Result<> PlanBuilder::add(PlannedSource source, const std::string& where) {
  if (!std::isfinite(source.strength_U) || source.strength_U <= 0.0) {
    return input_error(
        where,
        source.strength_U == 0.0
            ? std::string("the air-kerma strength is missing")
            : fmt::format("the air-kerma strength is {} U, a number above 0 is expected", source.strength_U),
        "Give strength_U for each seed, or once for all");
  }
  if (plan.implant == Implant::permanent && source.strength_U > kStrongestSeed_U) {
    return input_error(where,
                       fmt::format("the air-kerma strength is {:g} U, at most {:g} U is expected of a seed",
                                   source.strength_U, kStrongestSeed_U),
                       "Give the strength in U = µGy m²/h, or write \"implant\": \"temporary\"");
  }
  if (!std::isfinite(source.dwell_s) || source.dwell_s < 0.0)
    return input_error(where, fmt::format("the dwell time is {} s", source.dwell_s), "Give 0 s or more");
  if (Result<> reach = check_reach(where, source.at_mm, "the source"); !reach) return reach;
  if (source.has_axis) {
    const double length = source.axis.norm();
    if (!(length > 1e-6) || !std::isfinite(length))
      return input_error(where, "the axis has no length", "Give the axis as three numbers that are not all 0");
    source.axis /= length;
  }
  plan.sources.push_back(std::move(source));
  return Ok{};
}

Result<> PlanBuilder::add(const PlanNeedle& needle, const PlanTemplate& grid, const std::string& where) {
  Vec3 on_base = grid.origin_mm;
  if (needle.at_mm) {
    on_base = *needle.at_mm;
  } else {
    const auto offset = grid.grid.offset_mm(needle.hole);
    if (!offset)
      return input_error(fmt::format("{}, hole '{}'", where, needle.hole), offset.error().what, offset.error().cure);
    on_base += (*offset)[0] * grid.left + (*offset)[1] * grid.anterior;
  }
  if (!std::isfinite(needle.retraction_mm))
    return input_error(where, "the retraction is not a finite number", "Give the retraction plane in mm");
  std::vector<double> beyond_mm;  // of the retraction plane, superior
  for (const double distance : needle.seeds_mm) beyond_mm.push_back(-distance);
  if (needle.seeds_mm.empty()) {
    const Result<std::vector<double>> seeds = seeds_of_train(needle.train, grid.lengths, where);
    if (!seeds) return seeds.error();
    const double end_mm = grid.tip_offset_mm.value_or(0.5 * grid.lengths.seed_mm);
    for (const double along : *seeds) beyond_mm.push_back(end_mm - along);
  }
  for (const double beyond : beyond_mm) {
    PlannedSource seed;
    seed.at_mm = on_base + (beyond - needle.retraction_mm) * grid.direction;
    seed.axis = grid.direction;
    seed.has_axis = true;
    seed.strength_U = needle.strength_U;
    seed.needle = needle.at_mm ? needle.name : needle.hole;
    if (Result<> added = add(seed, where); !added) return added;
  }
  return Ok{};
}

Result<DosePlan> PlanBuilder::finish() {
  if (plan.sources.empty())
    return input_error(plan.file, "the plan has no seed", "Add seeds, or needles with trains of seeds");
  for (const auto& [key, date] :
       {std::pair("strength_date", &plan.strength_date), std::pair("plan_date", &plan.plan_date)}) {
    if (date->empty() || parse_date_time(*date)) continue;
    return input_error(fmt::format("{}, {}", plan.file, key), fmt::format("'{}' is no date of the calendar", *date),
                       "Write it as 2024-01-31, with a time as 2024-01-31 10:15");
  }
  std::size_t twins = 0;
  for (std::size_t a = 0; a < plan.sources.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if ((plan.sources[a].at_mm - plan.sources[b].at_mm).norm() < kSamePoint_mm) {
        ++twins;
        break;
      }
    }
  }
  if (twins > 0 && plan.implant == Implant::permanent) {
    plan.notes.push_back(
        fmt::format("{} seeds of {} stand at the place of another one; all are counted.", twins, plan.file));
  }
  return std::move(plan);
}

}  // namespace stylet::detail
