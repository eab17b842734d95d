// SPDX-License-Identifier: GPL-3.0-or-later
#include "summary_json.hpp"

#include "detail/json_text.hpp"
#include "probe_json.hpp"
#include "record/json.hpp"
#include "record/summary_columns.hpp"

namespace stylet::results {

using record::Json;

std::string summary_json(const Summary& summary, const ProbeReport* probe) {
  Json json = record::json_of(summary);
  if (probe) json["probe"] = probe_json(*probe);
  if (summary.in_place) json["in_place"] = record::json_of(*summary.in_place);
  return record::pretty(json);
}

Result<Summary> parse_summary_json(std::string_view text, const std::string& where) {
  const auto refuse = [&](const std::string& reason) {
    return input_error(where, "not a summary of a run: " + reason, "Give a file that this version of stylet wrote");
  };
  const Result<Json> parsed = detail::parse_json<Json>(text, where);
  if (!parsed) return refuse(parsed.error().what);
  const Json& json = *parsed;
  try {
    Summary summary;
    record::read_json(json, summary);
    if (json.contains("in_place")) record::read_json(json.at("in_place"), summary.in_place.emplace());
    return summary;
  } catch (const Json::parse_error&) {
    return refuse("it is not JSON");
  } catch (const Json::exception&) {
    return refuse("a value is missing or of another kind");
  } catch (const record::BadJson& e) {
    return refuse(e.what());
  }
}

}  // namespace stylet::results
