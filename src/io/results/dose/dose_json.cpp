// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/goal_text.hpp"
#include "record/json.hpp"
#include "stylet/core/version.hpp"
#include "stylet/io/dose_results.hpp"

namespace stylet {
namespace {

using record::Json, record::list_of, record::or_null;

Json dvh_row(const StructureDose& structure, double prescription_Gy) {
  const DoseVolume& dvh = structure.dvh;
  const auto percent_of = [&](double times) {
    return prescription_Gy > 0.0 ? Json(dvh.percent_above(times * prescription_Gy)) : Json(nullptr);
  };
  return {{"structure", structure.name},
          {"region", structure.region},
          {"type", structure.type},
          {"volume_cc", dvh.volume_cc()},
          {"D90_Gy", dvh.dose_of_percent(90.0)},
          {"D30_Gy", dvh.dose_of_percent(30.0)},
          {"D10_Gy", dvh.dose_of_percent(10.0)},
          {"D5_Gy", dvh.dose_of_percent(5.0)},
          {"D2cc_Gy", dvh.dose_of_volume(2.0)},
          {"D1cc_Gy", dvh.dose_of_volume(1.0)},
          {"D01cc_Gy", dvh.dose_of_volume(0.1)},
          {"V100_percent", percent_of(1.0)},
          {"V150_percent", percent_of(1.5)},
          {"V200_percent", percent_of(2.0)},
          {"V100_cc", prescription_Gy > 0.0 ? Json(dvh.volume_above_cc(prescription_Gy)) : Json(nullptr)},
          {"mean_Gy", dvh.mean_Gy()},
          {"covered_by_grid_percent", structure.covered_by_grid_percent}};
}

Json goal_row(const JudgedGoal& judged) {
  return {{"structure", judged.goal.structure},
          {"metric", judged.goal.metric},
          {"bound", results::bound_text(judged.goal)},
          {"value", or_null(judged.value)},
          {"met", judged.value ? Json(judged.met) : Json(nullptr)},
          {"citation", judged.goal.citation}};
}

Json point_row(const Vec3& x, double dose_Gy) {
  return {{"x_mm", x.x()}, {"y_mm", x.y()}, {"z_mm", x.z()}, {"dose_Gy", dose_Gy}};
}

Json gamma_json(const GammaRates& gamma) {
  return {{"dose_percent", gamma.criteria.dose_percent},
          {"distance_mm", gamma.criteria.distance_mm},
          {"threshold_percent", gamma.criteria.threshold_percent},
          {"global_Gy", gamma.global_Gy},
          {"points", gamma.points},
          {"local_pass_percent", gamma.local_percent},
          {"global_pass_percent", gamma.global_percent}};
}

Json comparison_json(const std::optional<DoseComparison>& comparison) {
  if (!comparison) return nullptr;
  return {{"median_ratio", comparison->median_ratio},
          {"p1", comparison->p1},
          {"p99", comparison->p99},
          {"points", comparison->points},
          {"file", comparison->file},
          {"gamma", comparison->gamma ? gamma_json(*comparison->gamma) : Json(nullptr)}};
}

Json strength_json(const StrengthAge& age) {
  return {{"date", or_null(age.strength_date)},
          {"plan_date", or_null(age.plan_date)},
          {"days_between", or_null(age.days)},
          {"decay_factor_between", or_null(age.factor_between)},
          {"decay_factor_used", age.factor_used}};
}

Json patient_json(const PatientRecord& p) {
  return {{"id", or_null(p.id)},
          {"name", or_null(p.name)},
          {"birth_date", or_null(p.birth_date)},
          {"sex", or_null(p.sex)},
          {"study_uid", or_null(p.study_uid)},
          {"study_date", or_null(p.study_date)},
          {"accession_number", or_null(p.accession_number)},
          {"frame_of_reference", or_null(p.frame_of_reference)},
          {"structure_set", or_null(p.structure_set)},
          {"from", or_null(p.file)}};
}

Json seed_row(const DoseEvaluation& evaluation, const PlannedSource& seed) {
  Json row = {{"position_mm", list_of(seed.at_mm)},
              {"axis", list_of(seed.axis)},
              {"strength_U", seed.strength_U},
              {"needle", seed.needle},
              {"dwell_s", seed.dwell_s}};
  if (!evaluation.more_sources.empty())
    row["source"] = seed.kind == 0 ? evaluation.source.name : evaluation.more_sources.at(seed.kind - 1).name;
  return row;
}

Json inputs_json(const std::vector<DoseInput>& inputs) {
  Json list = Json::array();
  for (const DoseInput& input : inputs) {
    list.push_back({{"role", input.role}, {"file", input.path}, {"sha256", or_null(input.sha256)}});
  }
  return list;
}

}  // namespace

std::string dose_json(const DoseEvaluation& evaluation) {
  Json dvh = Json::array(), goals = Json::array(), points = Json::array(), seeds = Json::array();
  for (const StructureDose& s : evaluation.structures) dvh.push_back(dvh_row(s, evaluation.prescription_Gy));
  for (const JudgedGoal& goal : evaluation.goals) goals.push_back(goal_row(goal));
  for (std::size_t k = 0; k < evaluation.points.size() && k < evaluation.point_Gy.size(); ++k)
    points.push_back(point_row(evaluation.points[k], evaluation.point_Gy[k]));
  for (const PlannedSource& seed : evaluation.plan.sources) seeds.push_back(seed_row(evaluation, seed));
  Json sources = {evaluation.source.name};
  for (const SourceModel& model : evaluation.more_sources) sources.push_back(model.name);
  const Json json = {
      {"seeds", evaluation.plan.sources.size()},
      {"source", evaluation.source.name},
      {"sources", sources},
      {"formalism", to_string(evaluation.formalism)},
      {"prescription_Gy", or_null(evaluation.prescription_Gy)},
      {"quantity", evaluation.quantity},
      {"implant", to_string(evaluation.plan.implant)},
      {"patient", patient_json(evaluation.patient)},
      {"strength", strength_json(evaluation.strength)},
      {"computed_on", or_null(evaluation.computed_on)},
      {"program", std::string("Stylet ") + version()},
      {"inputs", inputs_json(evaluation.inputs)},
      {"dvh", dvh},
      {"left_out", figures_left_out(evaluation.structures)},
      {"goals", goals},
      {"points", points},
      {"compare", comparison_json(evaluation.comparison)},
      {"seed_list", seeds},
      {"assumptions", evaluation.assumptions},
      {"warnings", evaluation.warnings},
  };
  return record::pretty(json);
}

}  // namespace stylet
