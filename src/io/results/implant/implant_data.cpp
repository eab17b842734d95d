// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/implant_data.hpp"

#include "implant/choice_sections.hpp"
#include "implant/found_json.hpp"
#include "implant/implant_words.hpp"
#include "implant/json_parts.hpp"
#include "implant/oedema_section.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace stylet::results {
namespace {

using record::Json;

double hundredths(double value) { return std::round(100.0 * value) / 100.0; }

Json seed_place_json(const Vec3& mm) { return {hundredths(mm.x()), hundredths(mm.y()), hundredths(mm.z())}; }

Json curves_json(const DvhTable& dvh) {
  Json percent = Json::array();
  for (const std::vector<double>& curve : dvh.percent) {
    Json& values = percent.emplace_back(Json::array());
    for (const double value : curve) values.push_back(hundredths(value));
  }
  return percent;
}

Json causes_json(const ImplantHistory& history) {
  Json list = Json::array();
  for (const CauseOfErrors& cause : causes_that_moved(history)) {
    list.push_back(
        {{"name", to_string(cause.cause)}, {"mean_mm", cause.mean_mm}, {"mean_xyz_mm", list_of(cause.mean_vector_mm)}});
  }
  return list;
}

/// For each section about choices, by its id, the distances of the seeds from their planned places under each choice.
Json choices_json(const ImplantOutcome& outcome) {
  Json sections = Json::object();
  for (const ChoiceSection& section : choice_sections(outcome)) {
    Json& list = sections[section.id] = Json::array();
    for (const ImplantChoice& choice : section.choices) {
      Json& mm = list.emplace_back(Json{{"name", choice.name}, {"distances_mm", Json::array()}})["distances_mm"];
      for (const SeedHistory& seed : choice.history->seeds) {
        if (!seed.lost) mm.push_back(hundredths(seed.error_mm().norm()));
      }
    }
  }
  return sections;
}

/// The needles that are in the tissue with others, each at the moment at which all needles of its group are in place:
/// the shaft from a little in front of the skin to the tip.
Json needles_in_place(const ImplantHistory& history) {
  constexpr double kInFrontOfSkin_mm = 25.0;
  Json list = Json::array();
  const auto add = [&](const NeedleHistory& needle, bool stabilises) {
    for (const NeedleShape& shape : needle.record.shapes) {
      if (shape.when != kAllInPlace) continue;
      Json points = Json::array();
      for (const Vec3& x : shape.points_mm) {
        if ((x - needle.entry_mm).dot(needle.direction) > -kInFrontOfSkin_mm) points.push_back(seed_place_json(x));
      }
      if (points.size() >= 2) list.push_back({{"name", needle.name}, {"stabilises", stabilises}, {"shaft_mm", points}});
    }
  };
  for (const NeedleHistory& needle : history.stabilising) add(needle, true);
  for (const NeedleHistory& needle : history.needles) add(needle, false);
  return list;
}

}  // namespace

std::string implant_page_data(const ImplantOutcome& outcome, const DvhTable& planned, const DvhTable* found) {
  const ImplantHistory& history = outcome.history;
  Json seeds = Json::array(), thirds = Json::array();
  const std::vector<std::size_t> third_of = thirds_of(history);
  for (std::size_t k = 0; k < history.seeds.size(); ++k) {
    const SeedHistory& seed = history.seeds[k];
    seeds.push_back({{"number", seed.number + 1},
                     {"needle", history.needles[seed.needle].name},
                     {"planned_mm", seed_place_json(seed.planned_mm)},
                     {"rest_mm", seed.lost ? Json(nullptr) : seed_place_json(seed.rest_mm)},
                     {"third", third_of[k]}});
  }
  for (std::size_t k = 0; k < kThirds.size(); ++k)
    thirds.push_back({{"name", kThirds[k]}, {"color", kThirdColours[k]}});
  const ImplantNouns& nouns = nouns_of(history);
  Json json = {
      {"planned_percent", curves_json(planned)},
      {"error", errors_json(seed_errors(history.seeds))},
      {"causes", causes_json(history)},
      {"choices", choices_json(outcome)},
      {"oedema", outcome.oedema ? oedema_curves_json(*outcome.oedema) : Json(nullptr)},
      {"nouns",
       {{"source", nouns.source}, {"sources", nouns.sources}, {"needle", nouns.needle}, {"needles", nouns.needles}}},
      {"thirds", thirds},
      {"seeds", seeds},
      {"needle_diameter_mm", outcome.scenario.needle.diameter_mm},
      {"needles", needles_in_place(history)}};
  if (found) {
    json["found_percent"] = curves_json(*found);
    json["found"] = found_json(history, *outcome.found);
  }
  return record::compact(json);
}

}  // namespace stylet::results
