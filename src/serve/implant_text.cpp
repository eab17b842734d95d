// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant_text.hpp"

#include "stylet/implant/seed_errors.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace stylet::serve {

namespace {

using ImplantJson = nlohmann::ordered_json;

constexpr double kPerMicrometre = 1e3;  // micrometres in a millimetre: places are written to a micrometre

ImplantJson place_json(const Vec3& x) {
  ImplantJson list = ImplantJson::array();
  for (const double value : x) list.push_back(std::round(kPerMicrometre * value) / kPerMicrometre);
  return list;
}

ImplantJson number_json(double value) { return std::isfinite(value) ? ImplantJson(value) : ImplantJson(nullptr); }

ImplantJson goals_json(const std::vector<JudgedGoal>& goals) {
  ImplantJson rows = ImplantJson::array();
  for (const JudgedGoal& row : goals) {
    rows.push_back({{"structure", row.goal.structure},
                    {"metric", row.goal.metric},
                    {"at_least", row.goal.at_least},
                    {"bound", row.goal.bound},
                    {"value", row.value ? number_json(*row.value) : ImplantJson(nullptr)},
                    {"met", row.met}});
  }
  return rows;
}

ImplantJson score_json(const std::optional<ImplantScore>& score) {
  if (!score) return nullptr;
  return {{"seeds", score->seeds},
          {"d90_Gy", number_json(score->d90_Gy)},
          {"d90_percent", number_json(score->d90_percent)},
          {"v100_percent", number_json(score->v100_percent)},
          {"took_ms", score->took_ms},
          {"goals", goals_json(score->goals)}};
}

/// The causes of a dropped seed. Where the hand held the needle stands in for the aim.
const char* word_of(SeedCause cause) { return cause == SeedCause::aim ? "hand" : to_string(cause); }

ImplantJson seed_row(const SeedHistory& seed) {
  ImplantJson why;
  for (const SeedCauseWords& words : kSeedCauses)
    if (words.of_drop != nullptr) why[word_of(words.cause)] = place_json(seed.by(words.cause));
  return {{"number", seed.number},
          {"needle", seed.needle},
          {"planned_mm", place_json(seed.planned_mm)},
          {"dropped_mm", place_json(seed.dropped_mm)},
          {"rest_mm", place_json(seed.rest_mm)},
          {"axis", place_json(seed.axis)},
          {"error_mm", seed.error_mm().norm()},
          {"in_tissue", seed.in_tissue},
          {"lost", seed.lost},
          {"why", why}};
}

ImplantJson error_json(std::span<const SeedHistory> seeds) {
  const SeedErrors errors = seed_errors(seeds);
  ImplantJson axes = ImplantJson::array();
  for (const SeedErrors::Axis& axis : errors.axes) axes.push_back({{"mean", axis.mean_mm}, {"sd", axis.sd_mm}});
  return {{"seeds", errors.seeds},
          {"mean_mm", errors.mean_mm},
          {"p95_mm", errors.p95_mm},
          {"largest_mm", errors.largest_mm},
          {"axes_mm", axes}};
}

/// The causes that have moved a seed.
ImplantJson causes_json(std::span<const SeedHistory> seeds) {
  ImplantJson rows = ImplantJson::array();
  for (const CauseOfErrors& of : causes_of_errors(seeds)) {
    if (words_of(of.cause).of_drop == nullptr || of.mean_mm == 0.0) continue;
    rows.push_back({{"cause", word_of(of.cause)},
                    {"meaning", words_of(of.cause).of_drop},
                    {"mean_mm", number_json(of.mean_mm)},
                    {"mean_xyz_mm", place_json(of.mean_vector_mm)}});
  }
  return rows;
}

std::string text_of_implant(const ImplantJson& json) {
  return json.dump(-1, ' ', false, ImplantJson::error_handler_t::replace);
}

}  // namespace

std::string plan_text(const ShownPlan& shown) {
  const RecordedPlan& plan = shown.plan;
  ImplantJson needles = ImplantJson::array();
  for (std::size_t k = 0; k < plan.needles.size(); ++k) {
    const RecordedPlan::Needle& needle = plan.needles[k];
    needles.push_back({{"name", needle.name},
                       {"hole", needle.hole},
                       {"entry_mm", place_json(needle.entry_mm)},
                       {"direction", place_json(needle.direction)},
                       {"depth_mm", needle.depth_mm},
                       {"ready", k < shown.ready.size() && shown.ready[k]},
                       {"seeds", ImplantJson::array()}});
  }
  for (const RecordedPlan::Seed& seed : plan.seeds) {
    needles[seed.needle]["seeds"].push_back({{"number", seed.number},
                                             {"planned_mm", place_json(seed.planned_mm)},
                                             {"axis", place_json(seed.axis)},
                                             {"drop_depth_mm", seed.drop_depth_mm}});
  }
  return text_of_implant({{"needles", needles},
                          {"current", plan.current},
                          {"seed_length_mm", plan.seed_length_mm},
                          {"seed_diameter_mm", plan.seed_diameter_mm},
                          {"prescription_Gy", plan.prescription_Gy},
                          {"source", plan.source},
                          {"technique", shown.technique == SeedTechnique::preloaded ? "preloaded" : "pushed"}});
}

std::string implant_text(const LiveImplant& implant) {
  ImplantJson seeds = ImplantJson::array();
  for (const SeedHistory& seed : implant.seeds) seeds.push_back(seed_row(seed));
  return text_of_implant(
      {{"planned_seeds", implant.planned_seeds},
       {"seeds", seeds},
       {"train_from_mm", implant.train_from_mm ? ImplantJson(*implant.train_from_mm) : ImplantJson(nullptr)},
       {"computing", implant.is_computing},
       {"now", score_json(implant.now)},
       {"planned", score_json(implant.planned)},
       {"error", error_json(implant.seeds)},
       {"lost", std::count_if(implant.seeds.begin(), implant.seeds.end(), [](const auto& s) { return s.lost; })},
       {"why", implant.seeds.empty() ? ImplantJson::array() : causes_json(implant.seeds)}});
}

std::string seeds_text(const LiveSeeds& seeds) {
  ImplantJson places = ImplantJson::array();
  for (const Vec3& x : seeds.now_mm) places.push_back(place_json(x));
  return text_of_implant({{"now_mm", places}});
}

}  // namespace stylet::serve
