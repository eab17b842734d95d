// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/found_json.hpp"
#include "implant/json_parts.hpp"
#include "implant/oedema_section.hpp"
#include "implant/shown_seeds.hpp"
#include "probe_json.hpp"
#include "record/json.hpp"
#include "stylet/core/version.hpp"
#include "stylet/io/dose_results.hpp"
#include "stylet/io/implant_results.hpp"

#include <nlohmann/json.hpp>

namespace stylet {
namespace {

using results::errors_json;
using results::list_of;
using results::OrderedJson;

OrderedJson parts_json(const std::vector<PartErrors>& parts) {
  OrderedJson rows = OrderedJson::array();
  for (const PartErrors& part : parts) {
    OrderedJson row{{"name", part.name}};
    row.update(errors_json(part.errors));
    rows.push_back(row);
  }
  return rows;
}

OrderedJson shift_json(const std::optional<Vec3>& shift_mm) {
  return shift_mm ? list_of(*shift_mm) : OrderedJson(nullptr);
}

/// The goals of the plan beside those of the implant. @param found those of the found seeds; null: none are given
OrderedJson goals_json(const OrderedJson& planned, const OrderedJson& delivered, const OrderedJson& found) {
  OrderedJson rows = OrderedJson::array();
  for (std::size_t k = 0; k < delivered.size(); ++k) {
    OrderedJson row = delivered[k];
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

OrderedJson dose_of(const DoseEvaluation& evaluation) {
  const OrderedJson dose = OrderedJson::parse(dose_json(evaluation));
  return {{"delivered_dvh", dose["dvh"]}, {"goals", dose["goals"]}};
}

/// @param found the seeds found on images, where there are any
OrderedJson other_json(const OtherImplant& other, const std::optional<FoundImplant>& found) {
  OrderedJson json = {{"name", other.name}, {"error", errors_json(seed_errors(other.history.seeds))}};
  json.update(dose_of(other.delivered));
  if (found) json["agreement"] = results::agreement_json(compare_found(other.history, found->seeds.seeds).all);
  return json;
}

}  // namespace

std::string implant_json(const ImplantOutcome& outcome) {
  const ImplantHistory& history = outcome.history;
  const OrderedJson planned = OrderedJson::parse(dose_json(outcome.planned));
  const OrderedJson delivered = OrderedJson::parse(dose_json(outcome.delivered));
  OrderedJson seeds = OrderedJson::array(), needles = OrderedJson::array(), why = OrderedJson::array();
  const bool temporary = implant_of(history.seeds) == Implant::temporary;
  for (const SeedHistory& seed : history.seeds) seeds.push_back(record::json_of(results::shown_seed(seed, outcome)));
  for (const NeedleHistory& needle : history.needles) needles.push_back(record::json_of(needle));
  for (const CauseOfErrors& cause : causes_of_errors(history.seeds)) {
    why.push_back({{"cause", to_string(cause.cause)},
                   {"mean_mm", cause.mean_mm},
                   {"mean_xyz_mm", list_of(cause.mean_vector_mm)}});
  }
  OrderedJson spans = OrderedJson::array();
  for (const OtherImplant& other : outcome.spans) spans.push_back(other_json(other, outcome.found));
  const OrderedJson found = outcome.found ? OrderedJson::parse(dose_json(outcome.found->dose)) : OrderedJson(nullptr);
  OrderedJson implant = {
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
      {"found_dvh", outcome.found ? found["dvh"] : OrderedJson(nullptr)},
      {"goals",
       goals_json(planned["goals"], delivered["goals"], outcome.found ? found["goals"] : OrderedJson(nullptr))},
      {"oedema", outcome.oedema ? results::oedema_json(*outcome.oedema) : OrderedJson(nullptr)},
      {"found", outcome.found ? results::found_json(history, *outcome.found) : OrderedJson(nullptr)},
      {"before_compensation", outcome.before ? other_json(*outcome.before, outcome.found) : OrderedJson(nullptr)},
      {"spans", spans},
      {"probe", outcome.probe ? results::probe_json(*outcome.probe) : OrderedJson(nullptr)},
      {"probe_out", outcome.probe_out ? dose_of(*outcome.probe_out) : OrderedJson(nullptr)},
      {"assumptions", delivered["assumptions"]}};
  if (temporary) {
    implant["planning_to_delivery_s"] = outcome.scenario.procedure.planning_to_delivery_s;
    implant["gland_at_planning_mm"] = shift_json(history.gland_at_planning_mm);
    implant["gland_at_delivery_mm"] = shift_json(history.gland_at_delivery_mm);
    implant["at_planning"] = outcome.at_planning ? other_json(*outcome.at_planning, {}) : OrderedJson(nullptr);
  }
  const OrderedJson json = {{"version", version()},
                            {"scenario", outcome.scenario.name},
                            {"nodes", history.nodes},
                            {"implant", implant},
                            {"warnings", outcome.warnings}};
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace stylet
