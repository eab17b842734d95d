// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/evaluate.hpp"

#include "dose/covered_percent.hpp"

#include "stylet/dose/fitting_sources.hpp"
#include "stylet/dose/rate_table.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

constexpr double kGy_per_cGy = 0.01;
constexpr double kGridMargin_mm = 10.0;
constexpr double kMostGridPoints = 4e6;
constexpr double kNearStructures_mm = 30.0;  // sources further than this from all structures belong to another patient
constexpr std::size_t kCloud = 4000;         // samples of a structure that are kept to draw it

Result<> check_positive(double value, const char* what, const std::string& where, const char* cure) {
  if (std::isfinite(value) && value > 0.0) return Ok{};
  return input_error(where, fmt::format("{} is {}, expected a number above 0", what, value), cure);
}

Result<> check_plan(const DosePlan& plan, const DoseOptions& options) {
  if (plan.sources.empty())
    return input_error(plan.file, "the plan has no source", "Give a plan with seeds or dwell positions");
  for (std::size_t k = 0; k < plan.sources.size(); ++k) {
    const PlannedSource& source = plan.sources[k];
    const std::string where = fmt::format("{}, source {}", plan.file, k + 1);
    if (!source.at_mm.allFinite() || !source.axis.allFinite())
      return input_error(where, "its place or axis is not finite", "Correct the plan");
    if (Result<> good =
            check_positive(source.strength_U, "its air-kerma strength [U]", where, "Give each source its strength");
        !good)
      return good;
    if (plan.implant == Implant::temporary && !(source.dwell_s >= 0.0 && std::isfinite(source.dwell_s)))
      return input_error(where, fmt::format("its dwell time is {} s", source.dwell_s), "Give a time of 0 s or more");
  }
  if (options.prescription_Gy != 0.0) {
    if (Result<> good = check_positive(options.prescription_Gy, "the prescription [Gy]", "prescription",
                                       "Give the prescribed dose in Gy");
        !good)
      return good;
  }
  if (options.quantity == DoseQuantity::until) {
    if (Result<> good = check_positive(options.days, "the time [d]", "days", "Give the days after the implantation");
        !good)
      return good;
  }
  if (!std::isfinite(options.decay_days))
    return input_error("decay days", "the time is not finite", "Give the days from the strengths' date to the implant");
  return check_positive(options.grid_step_mm, "the distance of grid points [mm]", "grid step", "Use 1 mm");
}

std::string words_of(const DosePlan& plan, const DoseOptions& options) {
  if (plan.implant == Implant::temporary) return "dose of all dwell times (Gy)";
  switch (options.quantity) {
    case DoseQuantity::total:
      return "total dose until the sources have decayed (Gy)";
    case DoseQuantity::initial_rate:
      return "initial dose rate (Gy/h; all figures in Gy are in Gy/h)";
    case DoseQuantity::until:
      return fmt::format("dose within {:g} days after the implantation (Gy)", options.days);
  }
  return "";
}

/// Smallest distance of a source from a sample of any structure, looked at every so many samples.
double distance_to_structures(const DosePlan& plan, std::span<const DoseStructure> structures) {
  double nearest = INFINITY;
  for (const DoseStructure& structure : structures) {
    const std::vector<Vec3>& points = structure.samples.points;
    const std::size_t stride = std::max<std::size_t>(1, points.size() / 2000);
    for (std::size_t p = 0; p < points.size(); p += stride) {
      for (const PlannedSource& source : plan.sources) nearest = std::min(nearest, (points[p] - source.at_mm).norm());
    }
  }
  return nearest;
}

Eigen::AlignedBox3d box_of(const std::vector<Vec3>& points) {
  Eigen::AlignedBox3d box;
  for (const Vec3& x : points) box.extend(x);
  return box;
}

/// A grid around all sources and structures; for structures larger than 30 cm, such as the body, around the sources.
DoseGrid empty_grid(const DosePlan& plan, std::span<const DoseStructure> structures, double step) {
  Eigen::AlignedBox3d box;
  for (const PlannedSource& source : plan.sources) box.extend(source.at_mm);
  for (const DoseStructure& structure : structures) {
    const Eigen::AlignedBox3d around = box_of(structure.samples.points);
    if (!around.isEmpty() && around.sizes().maxCoeff() < 300.0) box.extend(around);
  }
  const Vec3 low = box.min().array() - kGridMargin_mm, high = box.max().array() + kGridMargin_mm;
  const double volume = (high - low).prod();
  step = std::max(step, std::cbrt(volume / kMostGridPoints));
  DoseGrid grid;
  grid.frame_of_reference = plan.frame_of_reference;
  grid.origin_mm = low;
  grid.spacing_mm = Vec3::Constant(step);
  for (int axis = 0; axis < 3; ++axis)
    grid.size[static_cast<std::size_t>(axis)] = static_cast<Index>(std::ceil((high - low)[axis] / step)) + 1;
  return grid;
}

/// The parts of an implant's time as stretches of all distances; one without stretch where the swelling differs from
/// axis to axis.
std::vector<Stretch> stretches_of(const std::vector<SwollenTime>& times, bool alike) {
  if (!alike) return {Stretch{}};
  std::vector<Stretch> stretches;
  stretches.reserve(times.size());
  for (const SwollenTime& time : times) stretches.push_back({time.share, time.factors.x()});
  return stretches;
}

/// The dose over all parts of an implant's time. Swelling that is the same in all directions only makes distances
/// longer, so one table of the mean rate serves for all parts; otherwise the seeds are summed for each part.
class Dose {
 public:
  Dose(const Tg43& tg43, const DosePlan& plan, const SourceModel& source, const DoseOptions& options)
      : tg43_(tg43),
        swelling_(options.swelling),
        weighted_(weighted_sources(plan, source, options)),
        times_(times(plan, source, options)),
        alike_((swelling_.at_start.array() == swelling_.at_start.x()).all()),
        table_(tg43, stretches_of(times_, alike_)) {}

  /// Dose [Gy] at points by the formula itself, summed over all seeds for each part of the time.
  [[nodiscard]] std::vector<double> by_formula(const std::vector<Vec3>& points) const {
    return by_parts(points, tg43_);
  }
  /// The same by the table.
  [[nodiscard]] std::vector<double> by_table(const std::vector<Vec3>& points) const {
    if (!alike_) return by_parts(points, table_);
    std::vector<double> dose(points.size());
    sum_rates(table_, weighted_.sources, points, dose);
    for (double& value : dose) value *= weighted_.factor;
    return dose;
  }

 private:
  static std::vector<SwollenTime> times(const DosePlan& plan, const SourceModel& source, const DoseOptions& options) {
    if (plan.implant == Implant::temporary || !options.swelling.is_any()) return {SwollenTime{}};
    if (options.quantity == DoseQuantity::initial_rate) return {{1.0, options.swelling.factors(0.0)}};
    return swollen_times(options.swelling, source.half_life_days,
                         options.quantity == DoseQuantity::until ? options.days : INFINITY);
  }

  /// @param rates Tg43 or RateTable
  template <class Rates>
  [[nodiscard]] std::vector<double> by_parts(const std::vector<Vec3>& points, const Rates& rates) const {
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

  const Tg43& tg43_;
  Swelling swelling_;
  WeightedSources weighted_;
  std::vector<SwollenTime> times_;
  bool alike_;  ///< whether the swelling is the same in all directions
  RateTable table_;
};

void fill(DoseGrid& grid, const Dose& dose, const Progress& progress) {
  const auto layer = static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1]);
  grid.dose_Gy.resize(layer * static_cast<std::size_t>(grid.size[2]));
  std::vector<Vec3> points(layer);
  for (Index k = 0; k < grid.size[2]; ++k) {
    std::size_t p = 0;
    for (Index j = 0; j < grid.size[1]; ++j) {
      for (Index i = 0; i < grid.size[0]; ++i) points[p++] = grid.point(i, j, k);
    }
    const std::vector<double> here = dose.by_table(points);
    for (p = 0; p < layer; ++p) grid.dose_Gy[static_cast<std::size_t>(k) * layer + p] = static_cast<float>(here[p]);
    report(progress, "dose grid", (k + 1.0) / grid.size[2]);
  }
}

std::vector<Vec3> cloud_of(const StructureSamples& samples) {
  std::vector<Vec3> cloud;
  const std::size_t stride = std::max<std::size_t>(1, samples.points.size() / kCloud);
  for (std::size_t p = stride / 2; p < samples.points.size() && cloud.size() < kCloud; p += stride)
    cloud.push_back(samples.points[p]);
  return cloud;
}

Result<std::vector<JudgedGoal>> judge(const DoseEvaluation& evaluation, const std::vector<DoseGoal>& goals) {
  std::vector<JudgedGoal> judged;
  for (const DoseGoal& goal : goals) {
    const Result<DoseMetric> metric = parse_metric(goal.metric, "goal for " + goal.structure);
    if (!metric) return metric.error();
    JudgedGoal row{goal, std::nullopt, false};
    const auto structure =
        std::find_if(evaluation.structures.begin(), evaluation.structures.end(),
                     [&](const StructureDose& s) { return s.region == goal.structure || s.name == goal.structure; });
    if (structure != evaluation.structures.end())
      row.value = figure_of(*metric, structure->dvh, evaluation.prescription_Gy);
    if (row.value) row.met = meets(goal, *row.value);
    judged.push_back(row);
  }
  return judged;
}

void assume(DoseEvaluation& e, const DoseOptions& options) {
  e.assumptions.push_back(fmt::format("Source model: {} ({}); {}.", e.source.name, e.source.title, e.source.citation));
  const char* formalisms[] = {"line2d, a line source with the 2D anisotropy function",
                              "line1d, a line source with the 1D anisotropy function and no direction",
                              "point, a point source with the 1D anisotropy function and no direction"};
  e.assumptions.push_back(
      fmt::format("Formalism: {} (AAPM TG-43U1). All is water: no attenuation by other seeds, no bone.",
                  formalisms[static_cast<int>(options.formalism)]));
  const auto without =
      std::count_if(e.plan.sources.begin(), e.plan.sources.end(), [](const PlannedSource& s) { return !s.has_axis; });
  if (without > 0 && options.formalism == DoseFormalism::line2d) {
    e.assumptions.push_back(
        fmt::format("{} of {} sources have no direction in the plan; they are taken along z, inferior to superior.",
                    without, e.plan.sources.size()));
  }
  if (const std::string dates = strength_sentence(e.strength); !dates.empty()) {
    (strength_is_in_doubt(e.strength) ? e.warnings : e.assumptions).push_back(dates);
  }
  if (e.plan.implant == Implant::permanent) {
    e.assumptions.push_back(
        options.decay_days != 0.0
            ? fmt::format("The strengths have decayed for {:g} days before the implantation.", options.decay_days)
            : "The strengths are taken as those at the implantation, without decay since their date.");
  }
  if (options.swelling.is_any()) {
    e.assumptions.push_back(fmt::format(
        "The gland swells by {:g}, {:g} and {:g} % (left, posterior, superior) and shrinks again with a "
        "half-life of "
        "{:g} days; sources and tissue move with it, and each part of the tissue has the dose of its own way.",
        100.0 * options.swelling.at_start.x(), 100.0 * options.swelling.at_start.y(),
        100.0 * options.swelling.at_start.z(), options.swelling.half_life_days));
  }
  e.assumptions.emplace_back(
      "Contours stand for slabs that reach half-way to the neighbouring planes; the first and the last slab are as "
      "thick outside as inside.");
}

}  // namespace

const char* to_string(Implant implant) { return implant == Implant::permanent ? "permanent" : "temporary"; }

WeightedSources weighted_sources(const DosePlan& plan, const SourceModel& source, const DoseOptions& options) {
  WeightedSources out;
  constexpr double seconds_per_hour = 3600.0;
  const bool temporary = plan.implant == Implant::temporary;
  for (const PlannedSource& s : plan.sources) {
    const double weight = s.strength_U * (temporary ? s.dwell_s / seconds_per_hour : 1.0);
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

Result<DoseEvaluation> evaluate_dose(const DosePlan& plan, const SourceModel& source,
                                     std::span<const DoseStructure> structures, const DoseOptions& options,
                                     const Progress& progress) {
  if (Result<> good = check_plan(plan, options); !good) return good.error();
  Result<std::vector<std::string>> differences = compare_source(plan, source);
  if (!differences) return differences.error();
  const Result<Tg43> tg43 = Tg43::create(source, options.formalism);
  if (!tg43) return tg43.error();
  const double nearest = structures.empty() ? 0.0 : distance_to_structures(plan, structures);
  if (nearest > kNearStructures_mm) {
    return input_error(plan.file, fmt::format("the nearest source is {:.0f} mm away from all structures", nearest),
                       "Give the structures of this plan's patient, in the same frame of reference");
  }
  DoseEvaluation e;
  e.plan = plan;
  e.source = source;
  e.strength = strength_age(plan, source.half_life_days, options.decay_days);
  e.formalism = options.formalism;
  e.quantity = words_of(plan, options);
  e.prescription_Gy = options.prescription_Gy > 0.0 ? options.prescription_Gy : plan.prescription_Gy;
  e.warnings = std::move(*differences);

  const Dose dose(*tg43, plan, source, options);
  e.points = options.points;
  e.point_Gy = dose.by_formula(e.points);
  e.grid = empty_grid(plan, structures, options.grid_step_mm);
  fill(e.grid, dose, progress);
  for (std::size_t k = 0; k < structures.size(); ++k) {
    const DoseStructure& structure = structures[k];
    e.structures.push_back({structure.name, structure.region, structure.type, structure.colour,
                            DoseVolume(dose.by_table(structure.samples.points), structure.samples.volume_mm3),
                            dose::covered_percent(structure.samples, e.grid, Vec3::Zero()), structure.contours,
                            cloud_of(structure.samples)});
    report(progress, "dose to structures", static_cast<double>(k + 1) / static_cast<double>(structures.size()));
  }
  Result<std::vector<JudgedGoal>> goals = judge(e, options.goals);
  if (!goals) return goals.error();
  e.goals = std::move(*goals);
  assume(e, options);
  return e;
}

}  // namespace stylet
