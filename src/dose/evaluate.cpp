// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/evaluate.hpp"

#include "dose/covered_percent.hpp"
#include "dose/summed_dose.hpp"

#include "stylet/dose/plan_rules.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

constexpr double kGridMargin_mm = 10.0;
constexpr double kMostGridPoints = 4e6;
constexpr std::size_t kCloud = 4000;  // samples of a structure that are kept to draw it

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

void fill(DoseGrid& grid, const dose::SummedDose& dose, const Progress& progress) {
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

/// @param are_doses whether the figures are doses, and not dose rates, which no goal judges
Result<std::vector<JudgedGoal>> judge(const DoseEvaluation& evaluation, const std::vector<DoseGoal>& goals,
                                      bool are_doses) {
  std::vector<JudgedGoal> judged;
  for (const DoseGoal& goal : goals) {
    const Result<DoseMetric> metric = parse_metric(goal.metric, "goal for " + goal.structure);
    if (!metric) return metric.error();
    JudgedGoal row{goal, std::nullopt, false};
    const auto structure =
        std::find_if(evaluation.structures.begin(), evaluation.structures.end(),
                     [&](const StructureDose& s) { return s.region == goal.structure || s.name == goal.structure; });
    if (structure != evaluation.structures.end() && are_doses)
      row.value = figure_of(*metric, structure->dvh, evaluation.prescription_Gy);
    if (row.value) row.met = meets(goal, *row.value);
    judged.push_back(row);
  }
  return judged;
}

void assume(DoseEvaluation& e, const DoseOptions& options) {
  const auto say_model = [&](const SourceModel& model, const std::string& of) {
    e.assumptions.push_back(fmt::format("Source model{}: {} ({}); {}.", of, model.name, model.title, model.citation));
  };
  if (e.more_sources.empty()) {
    say_model(e.source, "");
  } else {
    for (std::size_t kind = 0; kind < kind_count(e.plan); ++kind)
      say_model(kind == 0 ? e.source : e.more_sources[kind - 1],
                fmt::format(" of source '{}'", source_kind(e.plan, kind).id));
  }
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
  if (e.plan.implant == Implant::temporary) {
    e.assumptions.push_back(fmt::format(
        "The strengths are {}; while a source lies it decays, and its mean strength counts.",
        options.decay_days != 0.0 ? fmt::format("those of {:g} days before the implant begins", options.decay_days)
                                  : std::string("those at the beginning of the implant")));
  } else if (options.quantity == DoseQuantity::initial_rate) {
    e.assumptions.emplace_back(
        "Figures are dose rates, so none is given in per cent of the prescribed dose, and no goal is judged.");
  } else if (options.quantity == DoseQuantity::until && !options.goals.empty()) {
    e.assumptions.push_back(fmt::format(
        "Goals are judged on the dose within {:g} days, not on that until the sources have decayed.", options.days));
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

const char* to_string(Implant implant) {
  return implant == Implant::permanent ? "permanent" : implant == Implant::temporary ? "temporary" : "unknown";
}

Result<DoseEvaluation> evaluate_dose(const DosePlan& plan, const SourceModel& source,
                                     std::span<const DoseStructure> structures, const DoseOptions& options,
                                     const Progress& progress) {
  if (Result<> good = check_plan(plan, options); !good) return good.error();
  std::vector<SourceModel> models{source};
  models.insert(models.end(), options.more_sources.begin(), options.more_sources.end());
  const Result<dose::SummedDose> summed = dose::SummedDose::create(plan, models, options);
  if (!summed) return summed.error();
  const dose::SummedDose& dose = *summed;
  Result<std::vector<std::string>> doubts = std::vector<std::string>();
  if (!options.judged) doubts = judge_plan(plan, models, structures, options);
  if (!doubts) return doubts.error();
  DoseEvaluation e;
  e.plan = plan;
  e.source = source;
  e.strength = strength_age(plan, source.half_life_days, options.decay_days);
  e.more_sources = options.more_sources;
  for (std::size_t k = 0; k < e.more_sources.size(); ++k) {  // the models of the computation, for writers
    SourceKind& kind = e.plan.more_kinds[k];
    const SourceModel& model = e.more_sources[k];
    kind.source_model = model.name;
    kind.isotope = model.isotope;
    kind.half_life_days = model.half_life_days;
    kind.source_length_mm = model.active_length_mm;
  }
  e.formalism = options.formalism;
  e.quantity = words_of(plan, options);
  e.prescription_Gy = options.prescription_Gy > 0.0 ? options.prescription_Gy : plan.prescription_Gy;
  // A dose rate has no share of a prescribed dose, and no goal is about it.
  const bool is_rate = options.quantity == DoseQuantity::initial_rate && plan.implant == Implant::permanent;
  if (is_rate) e.prescription_Gy = 0.0;
  e.warnings = std::move(*doubts);

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
  if (!options.judged && options.quantity == DoseQuantity::total) {
    const Result<std::vector<std::string>> of_dose = judge_dose(e);
    if (!of_dose) {
      Error error = of_dose.error();
      for (const std::string& doubt : e.warnings) error.what += "; " + doubt;
      if (error.what.ends_with('.')) error.what.pop_back();
      return error;
    }
    e.warnings.insert(e.warnings.end(), of_dose->begin(), of_dose->end());
  }
  Result<std::vector<JudgedGoal>> goals = judge(e, options.goals, !is_rate);
  if (!goals) return goals.error();
  e.goals = std::move(*goals);
  assume(e, options);
  return e;
}

}  // namespace stylet
