// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/found_json.hpp"

#include "implant/seed_rows.hpp"
#include "record/json.hpp"
#include "stylet/io/dose_results.hpp"

#include <algorithm>

namespace stylet::results {
namespace {

Json found_errors_json(const FoundErrors& errors) {
  Json parts = Json::array();
  for (const ErrorPart& part : errors.parts)
    parts.push_back({{"cause", part.name}, {"mm2", part.mean_mm2}, {"percent", part.percent}});
  return {{"error", errors_json(errors.error)},
          {"remainder", errors_json(errors.remainder)},
          {"mean_square_mm2", errors.mean_square_mm2},
          {"parts", parts}};
}

}  // namespace

Json agreement_json(const Agreement& agreement) {
  return {{"correlation", record::or_null(agreement.correlation)},
          {"explained_percent", record::or_null(agreement.explained_percent)}};
}

Json found_json(const ImplantHistory& history, const FoundImplant& found) {
  const FoundComparison& comparison = found.comparison;
  const SeedMatching& matching = comparison.matching;
  Json seeds = Json::array(), not_found = Json::array(), extra = Json::array();
  for (const MatchedSeed& matched : comparison.seeds)
    seeds.push_back(record::json_of(row_of_found(matched.seed, &matched, history, comparison)));
  for (const std::size_t k : matching.not_found) not_found.push_back(history.seeds[k].number + 1);
  for (const std::size_t k : matching.extra) {
    const FoundSeed& seed = found.seeds.seeds[k];
    extra.push_back({{"found_number", k + 1}, {"found_mm", list_of(seed.at_mm)}, {"where", seed.where}});
  }
  const Json dose = Json::parse(dose_json(found.dose_without_shift));
  return {{"file", found.seeds.file},
          {"found", found.seeds.seeds.size()},
          {"matched", comparison.seeds.size()},
          {"not_found", not_found},
          {"not_dropped", extra},
          {"ambiguous", std::count_if(matching.pairs.begin(), matching.pairs.end(),
                                      [](const SeedPair& pair) { return pair.ambiguous; })},
          {"match_limit_mm", kMatchLimit_mm},
          {"common_shift_mm", list_of(matching.shift_mm)},
          {"common_shift_standard_error_mm", list_of(matching.shift_error_mm)},
          {"common_shift_beyond_chance", matching.shift_beyond_chance()},
          {"frame_moved", matching.frame_moved},
          {"scatter_mm", matching.scatter_mm},
          {"as_found", found_errors_json(comparison.as_found)},
          {"without_shift", found_errors_json(comparison.without_shift)},
          {"agreement",
           {{"x", agreement_json(comparison.axes[0])},
            {"y", agreement_json(comparison.axes[1])},
            {"z", agreement_json(comparison.axes[2])},
            {"all", agreement_json(comparison.all)},
            {"correlation_by_chance", record::or_null(comparison.correlation_by_chance)}}},
          {"seeds", seeds},
          {"dvh_without_shift", dose["dvh"]},
          {"goals_without_shift", dose["goals"]}};
}

}  // namespace stylet::results
