// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/found_json.hpp"
#include "implant/json_parts.hpp"
#include "implant/oedema_section.hpp"
#include "implant/seed_rows.hpp"
#include "probe_json.hpp"
#include "record/json.hpp"
#include "stylet/core/version.hpp"
#include "stylet/io/dose_results.hpp"
#include "stylet/io/implant_results.hpp"

#include <nlohmann/json.hpp>

namespace stylet {
namespace {

using record::Json;
using results::errors_json;
using results::list_of;

Json parts_json(const std::vector<PartErrors>& parts) {
  Json rows = Json::array();
  for (const PartErrors& part : parts) {
    Json row{{"name", part.name}};
    row.update(errors_json(part.errors));
    rows.push_back(row);
  }
  return rows;
}

/// The goals of the plan beside those of the implant. @param found those of the found seeds; null: none are given
Json goals_json(const Json& planned, const Json& delivered, const Json& found) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < delivered.size(); ++k) {
    Json row = delivered[k];
    row["planned_value"] = planned[k]["value"];
    row["planned_met"] = planned[k]["met"];
    if (!found.is_null()) {
      row["found_value"] = found[k]["value"];
      row["found_met"] = found[k]["met"];
    }
    rows.push_back(row);
  }
  return rows;
}

Json dose_of(const DoseEvaluation& evaluation) {
  const Json dose = Json::parse(dose_json(evaluation));
  return {{"delivered_dvh", dose["dvh"]}, {"goals", dose["goals"]}};
}

/// @param found the seeds found on images, where there are any
Json other_json(const OtherImplant& other, const std::optional<FoundImplant>& found) {
  Json json = {{"name", other.name}, {"error", errors_json(seed_errors(other.history.seeds))}};
  json.update(dose_of(other.delivered));
  if (found) json["agreement"] = results::agreement_json(compare_found(other.history, found->seeds.seeds).all);
  return json;
}

}  // namespace

std::string implant_json(const ImplantOutcome& outcome) {
  const ImplantHistory& history = outcome.history;
  const Json planned = Json::parse(dose_json(outcome.planned));
  const Json delivered = Json::parse(dose_json(outcome.delivered));
  Json seeds = Json::array(), needles = Json::array(), why = Json::array();
  const bool temporary = implant_of(history.seeds) == Implant::temporary;
  for (const SeedHistory& seed : history.seeds) seeds.push_back(record::json_of(results::row_of_seed(seed, outcome)));
  for (const NeedleHistory& needle : history.needles) needles.push_back(record::json_of(needle));
  for (const CauseOfErrors& cause : causes_of_errors(history.seeds)) {
    why.push_back({{"cause", to_string(cause.cause)},
                   {"mean_mm", cause.mean_mm},
                   {"mean_xyz_mm", list_of(cause.mean_vector_mm)}});
  }
  Json spans = Json::array();
  for (const OtherImplant& other : outcome.spans) spans.push_back(other_json(other, outcome.found));
  const Json found = outcome.found ? Json::parse(dose_json(outcome.found->dose)) : Json(nullptr);
  Json implant = {
      {"source", outcome.delivered.source.name},
      {"prescription_Gy", delivered["prescription_Gy"]},
      {temporary ? "dwell_positions" : "seeds", seeds},
      {temporary ? "catheters" : "needles", needles},
      {"error", errors_json(seed_errors(history.seeds))},
      {"error_by_needle", parts_json(errors_by_needle(history))},
      {"error_by_third", parts_json(errors_by_third(history))},
      {"why", why},
      {"planned_dvh", planned["dvh"]},
      {"delivered_dvh", delivered["dvh"]},
      {"found_dvh", outcome.found ? found["dvh"] : Json(nullptr)},
      {"goals", goals_json(planned["goals"], delivered["goals"], outcome.found ? found["goals"] : Json(nullptr))},
      {"oedema", outcome.oedema ? results::oedema_json(*outcome.oedema) : Json(nullptr)},
      {"found", outcome.found ? results::found_json(history, *outcome.found) : Json(nullptr)},
      {"before_compensation", outcome.before ? other_json(*outcome.before, outcome.found) : Json(nullptr)},
      {"spans", spans},
      {"probe", outcome.probe ? results::probe_json(*outcome.probe) : Json(nullptr)},
      {"probe_out", outcome.probe_out ? dose_of(*outcome.probe_out) : Json(nullptr)},
      {"assumptions", delivered["assumptions"]}};
  if (temporary) {
    implant["planning_to_delivery_s"] = outcome.scenario.procedure.planning_to_delivery_s;
    implant["gland_at_planning_mm"] =
        history.gland_at_planning_mm ? list_of(*history.gland_at_planning_mm) : Json(nullptr);
    implant["gland_at_delivery_mm"] =
        history.gland_at_delivery_mm ? list_of(*history.gland_at_delivery_mm) : Json(nullptr);
    implant["at_planning"] = outcome.at_planning ? other_json(*outcome.at_planning, {}) : Json(nullptr);
  }
  const Json json = {{"version", version()},
                     {"scenario", outcome.scenario.name},
                     {"nodes", history.nodes},
                     {"implant", implant},
                     {"warnings", outcome.warnings}};
  return record::pretty(json);
}

}  // namespace stylet
