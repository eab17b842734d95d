// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/plan_builder.hpp"

#include "detail/reach.hpp"
#include "stylet/dose/strength_age.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stylet::detail {

namespace {}  // namespace

Result<std::size_t> PlanBuilder::kind_of(const std::string& model, const std::string& where) {
  const bool is_first = plan.sources.empty() && plan.source_model.empty();
  if (model.empty()) {
    if (!named_by_seeds_) return std::size_t{0};
    return input_error(where, "it names no source model, and others do",
                       "Name the source of each seed, or one for all");
  }
  if (is_first) {
    named_by_seeds_ = true;
    plan.source_model = plan.source_id = model;
  } else if (plan.source_model.empty()) {
    return input_error(where, "it names a source model, and the ones before do not",
                       "Name the source of each seed, or one for all");
  }
  for (std::size_t kind = 0; kind < kind_count(plan); ++kind) {
    if (source_kind(plan, kind).source_model == model) return kind;
  }
  SourceKind kind;
  kind.id = kind.source_model = model;
  kind.strength_date = plan.strength_date;
  plan.more_kinds.push_back(kind);
  return plan.more_kinds.size();
}

Result<> PlanBuilder::add(PlannedSource source, const std::string& where) {
  if (!std::isfinite(source.strength_U) || source.strength_U <= 0.0) {
    return input_error(
        where,
        source.strength_U == 0.0
            ? std::string("the air-kerma strength is missing")
            : fmt::format("the air-kerma strength is {} U, a number above 0 is expected", source.strength_U),
        "Give strength_U for each seed, or once for all");
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
  if (plan.implant == Implant::permanent) {
    plan.says.without_dwell_time = 0;
    for (const PlannedSource& source : plan.sources) plan.says.dwell_of_permanent_s += source.dwell_s;
  }
  return std::move(plan);
}

}  // namespace stylet::detail
