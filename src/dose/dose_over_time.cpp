// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/dose_over_time.hpp"

#include "stylet/dose/rate_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace stylet {

namespace {

constexpr std::size_t kMostSamplesOfCourse = 100'000;

/// One sample of each group of neighbours, chosen at random, so that no pattern of the samples is followed. It stands
/// for the volume of its group.
StructureSamples thinned(const StructureSamples& samples) {
  const std::size_t all = samples.points.size();
  const std::size_t group = (all + kMostSamplesOfCourse - 1) / kMostSamplesOfCourse;
  if (group <= 1) return samples;
  std::mt19937 random(1);
  StructureSamples few;
  for (std::size_t first = 0; first < all; first += group) {
    const std::size_t last = std::min(first + group, all);
    double volume = 0.0;
    for (std::size_t k = first; k < last; ++k) volume += samples.volume_mm3[k];
    few.points.push_back(samples.points[first + random() % (last - first)]);
    few.volume_mm3.push_back(volume);
  }
  return few;
}

double d90_of(const std::vector<double>& dose_Gy, const StructureSamples& samples) {
  return DoseVolume(dose_Gy, samples.volume_mm3).dose_of_percent(90.0);
}

/// The dose rates [cGy/h] at the samples when the sources are implanted, while the widths have these factors.
void rates_at(const RateTable& table, const std::vector<PlacedSource>& sources, const StructureSamples& samples,
              const Swelling& swelling, const Vec3& factors, std::vector<double>& rates) {
  std::vector<PlacedSource> placed = sources;
  for (PlacedSource& source : placed) {
    source.at_mm = swelling.moved(source.at_mm, factors);
    source.axis = factors.cwiseProduct(source.axis).normalized();
  }
  std::vector<Vec3> points = samples.points;
  for (Vec3& x : points) x = swelling.moved(x, factors);
  sum_rates(table, placed, points, rates);
}

double share_at(double days, double half_life_days) { return -std::expm1(-std::log(2.0) * days / half_life_days); }

/// The last moment, which has a share of 1 whatever the sum of the parts' shares is rounded to, is at infinity.
double days_at(double share, double half_life_days) {
  return share > 1.0 - 1e-9 ? std::numeric_limits<double>::infinity() : -half_life_days * std::log2(1.0 - share);
}

}  // namespace

DoseMoment DoseCourse::at(double days) const {
  const double share = share_at(days, half_life_days);
  const auto after =
      std::find_if(moments.begin(), moments.end(), [&](const DoseMoment& m) { return m.share >= share; });
  if (after == moments.begin()) return moments.front();
  if (after == moments.end()) return moments.back();
  const DoseMoment& from = *(after - 1);
  const double part = (share - from.share) / (after->share - from.share);
  return {days, share, std::lerp(from.d90_Gy, after->d90_Gy, part),
          std::lerp(from.d90_without_swelling_Gy, after->d90_without_swelling_Gy, part)};
}

double DoseCourse::days_until_half_is_taken() const {
  const double half = 0.5 * moments.back().taken_away_Gy();
  if (half == 0.0) return std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 1; k < moments.size(); ++k) {
    const double from = moments[k - 1].taken_away_Gy() / half, to = moments[k].taken_away_Gy() / half;
    if (to < 1.0) continue;
    return days_at(std::lerp(moments[k - 1].share, moments[k].share, (1.0 - from) / (to - from)), half_life_days);
  }
  return std::numeric_limits<double>::infinity();
}

Result<DoseCourse> d90_over_time(const DosePlan& plan, const SourceModel& source, const StructureSamples& samples,
                                 const DoseOptions& options) {
  if (plan.implant == Implant::temporary) {
    return input_error(plan.file, "a temporary implant has ended before tissue swells",
                       "Ask for the course of the dose for permanent implants only");
  }
  if (plan.sources.empty()) return input_error(plan.file, "the plan has no source", "Give a plan with seeds");
  if (samples.points.empty())
    return input_error(plan.file, "the structure has no samples", "Give a structure with a volume");
  Result<Tg43> tg43 = Tg43::create(source, options.formalism);
  if (!tg43) return tg43.error();
  const RateTable table(*std::move(tg43));
  DoseOptions in_all = options;
  in_all.quantity = DoseQuantity::total;
  const auto [sources, factor] = weighted_sources(plan, source, in_all);
  const StructureSamples few = thinned(samples);

  DoseCourse course{.moments = {},
                    .swelling = options.swelling,
                    .half_life_days = source.half_life_days,
                    .samples = few.points.size()};
  std::vector<double> rates(few.points.size()), dose(few.points.size(), 0.0);
  rates_at(table, sources, few, course.swelling, Vec3::Ones(), rates);
  const double without_swelling = factor * d90_of(rates, few);
  course.moments.push_back({});
  double share = 0.0;
  for (const SwollenTime& time :
       swollen_times(course.swelling, source.half_life_days, std::numeric_limits<double>::infinity())) {
    rates_at(table, sources, few, course.swelling, time.factors, rates);
    for (std::size_t k = 0; k < dose.size(); ++k) dose[k] += factor * time.share * rates[k];
    share += time.share;
    course.moments.push_back(
        {days_at(share, source.half_life_days), share, d90_of(dose, few), share * without_swelling});
  }
  return course;
}

}  // namespace stylet
