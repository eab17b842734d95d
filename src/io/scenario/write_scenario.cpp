// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/version.hpp"
#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace stylet {

namespace {

/// The text of a key in TOML: without quotes if that is allowed and it does not look like a number.
std::string key_text(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return (c < 0x80 && std::isalnum(c) != 0) || c == '_' || c == '-';
  });
  const bool word = key.find_first_not_of("-0123456789") != std::string::npos;
  return bare && word ? key : to_string({.type = ScenarioValue::Type::text, .text = key});
}

struct Line {
  std::string text;
  std::string unit;
};

/// The text of a table, with units aligned behind the values.
std::string table_text(const std::string& header, const std::vector<Line>& lines) {
  std::size_t width = 0;
  for (const Line& line : lines) {
    if (!line.unit.empty()) width = std::max(width, line.text.size());
  }
  std::string out = header.empty() ? "" : "\n" + header + "\n";
  for (const Line& line : lines) {
    out += line.unit.empty() ? line.text + "\n" : fmt::format("{:<{}}  # {}\n", line.text, width, line.unit);
  }
  return out;
}

/// The lines for all keys of one table that are set.
/// @param pattern e.g. "tissue.<region>" @param path the pattern with its wildcard filled in, e.g. "tissue.prostate"
std::vector<Line> lines_of(const Scenario& scenario, const std::string& pattern, const std::string& path) {
  std::vector<Line> lines;
  for (const ScenarioKey& key : scenario_keys()) {
    const auto dot = key.path.rfind('.');
    if ((dot == std::string::npos ? "" : key.path.substr(0, dot)) != pattern) continue;
    const std::string name = key.path.substr(dot == std::string::npos ? 0 : dot + 1);
    const auto value = scenario_value(scenario, path.empty() ? name : fmt::format("{}.{}", path, name));
    if (!value) continue;
    const bool left_out = value->type == ScenarioValue::Type::text && value->text.empty() && key.standard == "none";
    if (!left_out) lines.push_back({name + " = " + to_string(*value), key.unit});
  }
  return lines;
}

}  // namespace

std::string to_toml(const Scenario& scenario) {
  std::string out = fmt::format("# Scenario as Stylet {} understood it, defaults included.\n", version());
  std::string last = "?";
  for (const ScenarioKey& key : scenario_keys()) {
    const auto dot = key.path.rfind('.');
    const std::string pattern = dot == std::string::npos ? "" : key.path.substr(0, dot);
    if (pattern == last) continue;
    last = pattern;
    if (pattern == "tissue.<region>") {
      for (const auto& [region, parameters] : scenario.tissue) {
        out += table_text("[tissue." + key_text(region) + "]", lines_of(scenario, pattern, "tissue." + region));
      }
    } else if (pattern == "patient.regions") {
      std::vector<Line> lines;
      for (const auto& [name, region] : scenario.patient.regions) {
        lines.push_back({key_text(name) + " = " + to_string({.type = ScenarioValue::Type::text, .text = region}), ""});
      }
      if (!lines.empty()) out += table_text("[patient.regions]", lines);
    } else if (pattern.ends_with("[]")) {
      const std::string list = pattern.substr(0, pattern.size() - 2);
      const std::size_t entries = list == "insertion"     ? scenario.insertions.size()
                                  : list == "plan.needle" ? scenario.plan.needles.size()
                                                          : scenario.plan.goal_table.size();
      for (std::size_t i = 0; i < entries; ++i)
        out += table_text("[[" + list + "]]", lines_of(scenario, pattern, fmt::format("{}[{}]", list, i)));
    } else {
      out += table_text(pattern.empty() ? "" : "[" + pattern + "]", lines_of(scenario, pattern, pattern));
    }
  }
  return out;
}

}  // namespace stylet
