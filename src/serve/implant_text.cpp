// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant_text.hpp"

#include "stylet/implant/seed_errors.hpp"

#include "io/record/json.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::serve {

namespace {

using record::compact;
using record::Json;
using record::or_null;

constexpr double kPerMicrometre = 1e3;  // micrometres in a millimetre: places are written to a micrometre

Json place_json(const Vec3& x) {
  Json list = Json::array();
  for (const double value : x) list.push_back(std::round(kPerMicrometre * value) / kPerMicrometre);
  return list;
}

Json goals_json(const std::vector<JudgedGoal>& goals) {
  Json rows = Json::array();
  for (const JudgedGoal& row : goals) {
    rows.push_back({{"structure", row.goal.structure},
                    {"metric", row.goal.metric},
                    {"at_least", row.goal.at_least},
                    {"bound", row.goal.bound},
                    {"value", or_null(row.value)},
                    {"met", row.met}});
  }
  return rows;
}

Json score_json(const std::optional<ImplantScore>& score) {
  if (!score) return nullptr;
  return {{"seeds", score->seeds},
          {"d90_Gy", score->d90_Gy},
          {"d90_percent", score->d90_percent},
          {"v100_percent", score->v100_percent},
          {"took_ms", score->took_ms},
          {"goals", goals_json(score->goals)}};
}

/// The causes of a dropped seed. Where the hand held the needle stands in for the aim.
const char* word_of(SeedCause cause) { return cause == SeedCause::aim ? "hand" : to_string(cause); }

Json seed_row(const SeedHistory& seed) {
  Json why;
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

Json error_json(std::span<const SeedHistory> seeds) {
  const SeedErrors errors = seed_errors(seeds);
  Json axes = Json::array();
  for (const SeedErrors::Axis& axis : errors.axes) axes.push_back({{"mean", axis.mean_mm}, {"sd", axis.sd_mm}});
  return {{"seeds", errors.seeds},
          {"mean_mm", errors.mean_mm},
          {"p95_mm", errors.p95_mm},
          {"largest_mm", errors.largest_mm},
          {"axes_mm", axes}};
}

/// The causes that have moved a seed.
Json causes_json(std::span<const SeedHistory> seeds) {
  Json rows = Json::array();
  for (const CauseOfErrors& of : causes_of_errors(seeds)) {
    if (words_of(of.cause).of_drop == nullptr || of.mean_mm == 0.0) continue;
    rows.push_back({{"cause", word_of(of.cause)},
                    {"meaning", words_of(of.cause).of_drop},
                    {"mean_mm", of.mean_mm},
                    {"mean_xyz_mm", place_json(of.mean_vector_mm)}});
  }
  return rows;
}

}  // namespace

std::string plan_text(const ShownPlan& shown) {
  const RecordedPlan& plan = shown.plan;
  Json needles = Json::array();
  for (std::size_t k = 0; k < plan.needles.size(); ++k) {
    const RecordedPlan::Needle& needle = plan.needles[k];
    needles.push_back({{"name", needle.name},
                       {"hole", needle.hole},
                       {"entry_mm", place_json(needle.entry_mm)},
                       {"direction", place_json(needle.direction)},
                       {"depth_mm", needle.depth_mm},
                       {"ready", k < shown.ready.size() && shown.ready[k]},
                       {"seeds", Json::array()}});
  }
  for (const RecordedPlan::Seed& seed : plan.seeds) {
    needles[seed.needle]["seeds"].push_back({{"number", seed.number},
                                             {"planned_mm", place_json(seed.planned_mm)},
                                             {"axis", place_json(seed.axis)},
                                             {"drop_depth_mm", seed.drop_depth_mm}});
  }
  return compact({{"needles", needles},
                  {"current", plan.current},
                  {"seed_length_mm", plan.seed_length_mm},
                  {"seed_diameter_mm", plan.seed_diameter_mm},
                  {"prescription_Gy", plan.prescription_Gy},
                  {"source", plan.source},
                  {"technique", shown.technique == SeedTechnique::preloaded ? "preloaded" : "pushed"}});
}

std::string implant_text(const LiveImplant& implant) {
  Json seeds = Json::array();
  for (const SeedHistory& seed : implant.seeds) seeds.push_back(seed_row(seed));
  return compact(
      {{"planned_seeds", implant.planned_seeds},
       {"seeds", seeds},
       {"train_from_mm", or_null(implant.train_from_mm)},
       {"computing", implant.is_computing},
       {"now", score_json(implant.now)},
       {"planned", score_json(implant.planned)},
       {"error", error_json(implant.seeds)},
       {"lost", std::count_if(implant.seeds.begin(), implant.seeds.end(), [](const auto& s) { return s.lost; })},
       {"tally",
        {{"skin_punctures", implant.tally.skin_punctures},
         {"organ_entries", implant.tally.organ_entries},
         {"bone_contacts", implant.tally.bone_contacts},
         {"exits", implant.tally.exits}}},
       {"why", implant.seeds.empty() ? Json::array() : causes_json(implant.seeds)}});
}

std::string seeds_text(const LiveSeeds& seeds) {
  Json places = Json::array();
  for (const Vec3& x : seeds.now_mm) places.push_back(place_json(x));
  return compact({{"now_mm", places}});
}

}  // namespace stylet::serve
