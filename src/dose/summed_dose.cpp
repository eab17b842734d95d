// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/summed_dose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

constexpr double kGy_per_cGy = 0.01;

}  // namespace

namespace dose {

namespace {

/// The parts of an implant's time as stretches of all distances; one without stretch where the swelling differs from
/// axis to axis.
std::vector<Stretch> stretches_of(const std::vector<SwollenTime>& times, bool alike) {
  if (!alike) return {Stretch{}};
  std::vector<Stretch> stretches;
  stretches.reserve(times.size());
  for (const SwollenTime& time : times) stretches.push_back({time.share, time.factors.x()});
  return stretches;
}

std::vector<SwollenTime> parts_of_time(const DosePlan& plan, const SourceModel& source, const DoseOptions& options) {
  if (plan.implant == Implant::temporary || !options.swelling.is_any()) return {SwollenTime{}};
  if (options.quantity == DoseQuantity::initial_rate) return {{1.0, options.swelling.factors(0.0)}};
  return swollen_times(options.swelling, source.half_life_days,
                       options.quantity == DoseQuantity::until ? options.days : INFINITY);
}

}  // namespace

DoseOfKind::DoseOfKind(const Tg43& tg43, const DosePlan& plan, const DoseOptions& options, std::size_t kind)
    : tg43_(tg43),
      swelling_(options.swelling),
      weighted_(weighted_sources(plan, tg43.source(), options, kind)),
      times_(parts_of_time(plan, tg43.source(), options)),
      alike_((swelling_.at_start.array() == swelling_.at_start.x()).all()),
      table_(tg43, stretches_of(times_, alike_)) {}

std::vector<double> DoseOfKind::by_formula(const std::vector<Vec3>& points) const { return by_parts(points, tg43_); }

std::vector<double> DoseOfKind::by_table(const std::vector<Vec3>& points) const {
  if (!alike_) return by_parts(points, table_);
  std::vector<double> dose(points.size());
  sum_rates(table_, weighted_.sources, points, dose);
  for (double& value : dose) value *= weighted_.factor;
  return dose;
}

template <class Rates>
std::vector<double> DoseOfKind::by_parts(const std::vector<Vec3>& points, const Rates& rates) const {
  std::vector<double> dose(points.size(), 0.0), of_part(points.size());
  std::vector<Vec3> moved = points;
  std::vector<PlacedSource> sources = weighted_.sources;
  for (const SwollenTime& time : times_) {
    for (std::size_t p = 0; p < points.size(); ++p) moved[p] = swelling_.moved(points[p], time.factors);
    for (std::size_t k = 0; k < sources.size(); ++k) {
      sources[k].at_mm = swelling_.moved(weighted_.sources[k].at_mm, time.factors);
      sources[k].axis = time.factors.cwiseProduct(weighted_.sources[k].axis).normalized();
    }
    sum_rates(rates, sources, moved, of_part);
    for (std::size_t p = 0; p < points.size(); ++p) dose[p] += time.share * weighted_.factor * of_part[p];
  }
  return dose;
}

Result<SummedDose> SummedDose::create(const DosePlan& plan, std::span<const SourceModel> models,
                                      const DoseOptions& options) {
  if (models.size() != kind_count(plan)) {
    return input_error(
        plan.file,
        fmt::format("the plan has {} kinds of source, and {} source models are given", kind_count(plan), models.size()),
        "Give a source model for each kind (--source ID=NAME)");
  }
  SummedDose dose;
  for (std::size_t kind = 0; kind < models.size(); ++kind) {
    Result<Tg43> tg43 = Tg43::create(models[kind], options.formalism);
    if (!tg43) return tg43.error();
    dose.kinds_.emplace_back(*tg43, plan, options, kind);
  }
  return dose;
}

std::vector<double> SummedDose::by_formula(const std::vector<Vec3>& points) const {
  return sum(points.size(), [&](const DoseOfKind& kind) { return kind.by_formula(points); });
}

std::vector<double> SummedDose::by_table(const std::vector<Vec3>& points) const {
  return sum(points.size(), [&](const DoseOfKind& kind) { return kind.by_table(points); });
}

template <class Of>
std::vector<double> SummedDose::sum(std::size_t count, const Of& of) const {
  if (kinds_.size() == 1) return of(kinds_.front());
  std::vector<double> all(count, 0.0);
  for (const DoseOfKind& kind : kinds_) {
    const std::vector<double> dose = of(kind);
    for (std::size_t p = 0; p < count; ++p) all[p] += dose[p];
  }
  return all;
}

}  // namespace dose

WeightedSources weighted_sources(const DosePlan& plan, const SourceModel& source, const DoseOptions& options,
                                 std::size_t kind) {
  WeightedSources out;
  constexpr double seconds_per_hour = 3600.0;
  const bool temporary = plan.implant == Implant::temporary;
  for (const PlannedSource& s : plan.sources) {
    if (s.kind != kind) continue;
    const double lies_h = std::max(s.dwell_s, s.over_s) / seconds_per_hour;
    const double weight =
        s.strength_U *
        (temporary ? s.dwell_s / seconds_per_hour * mean_strength_while_decaying(lies_h, source.half_life_days) : 1.0);
    if (weight > 0.0) out.sources.push_back({s.at_mm, s.axis, weight});
  }
  out.factor = kGy_per_cGy;
  if (!temporary && options.quantity != DoseQuantity::initial_rate)
    out.factor = permanent_Gy_per_rate(source.half_life_days);
  if (!temporary && options.quantity == DoseQuantity::until)
    out.factor *= -std::expm1(-std::numbers::ln2 * options.days / source.half_life_days);
  out.factor *= std::exp2(-options.decay_days / source.half_life_days);
  return out;
}

Result<std::vector<double>> doses_at(const DoseEvaluation& evaluation, const DoseOptions& options,
                                     std::span<const Vec3> points) {
  std::vector<double> dose(points.size(), 0.0), rates(points.size());
  for (std::size_t kind = 0; kind < kind_count(evaluation.plan); ++kind) {
    const SourceModel& source = kind == 0 ? evaluation.source : evaluation.more_sources.at(kind - 1);
    Result<Tg43> tg43 = Tg43::create(source, evaluation.formalism);
    if (!tg43) return tg43.error();
    const WeightedSources weighted = weighted_sources(evaluation.plan, source, options, kind);
    sum_rates(RateTable(*std::move(tg43)), weighted.sources, points, rates);
    for (std::size_t p = 0; p < points.size(); ++p) dose[p] += weighted.factor * rates[p];
  }
  return dose;
}

}  // namespace stylet
