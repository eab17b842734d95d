// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/parameter_tables.hpp"

#include "report/text.hpp"
#include "stylet/io/region_views.hpp"
#include "stylet/sim/scenario.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

namespace stylet::results {
namespace {

constexpr std::string_view kTissue = "tissue.";

/// Properties of one region.
struct Tissue {
  std::string region;
  std::vector<const ParameterRow*> rows;
};

/// The key of a row: "young_kPa" for "tissue.prostate.young_kPa"; empty for "tissue.pubic_arch".
std::string key_of(const ParameterRow& row) {
  const std::size_t dot = row.name.find('.', kTissue.size());
  return dot == std::string::npos ? std::string() : row.name.substr(dot + 1);
}

std::string region_of(const ParameterRow& row) {
  return row.name.substr(kTissue.size(), row.name.find('.', kTissue.size()) - kTissue.size());
}

/// Whether a row belongs to one tissue. "tissue.element" and similar keys apply to all tissue.
bool is_tissue(const ParameterRow& row) {
  const auto& keys = scenario_keys();
  return row.name.starts_with(kTissue) &&
         std::none_of(keys.begin(), keys.end(), [&](const ScenarioKey& key) { return key.path == row.name; });
}

/// The sources of a tissue's values; if there are several, each with its keys.
std::string sources_of(const Tissue& tissue) {
  struct Source {
    std::string text, keys;
  };
  std::vector<Source> sources;
  for (const ParameterRow* row : tissue.rows) {
    auto known = std::find_if(sources.begin(), sources.end(), [&](const Source& s) { return s.text == row->source; });
    if (known == sources.end()) {
      sources.push_back({row->source, key_of(*row)});
    } else {
      known->keys += ", " + key_of(*row);
    }
  }
  if (sources.size() == 1) return html_escaped(sources[0].text);
  std::string html;
  for (const Source& s : sources) {
    html += "<div><code>" + html_escaped(s.keys) + "</code>: " + html_escaped(s.text) + "</div>";
  }
  return html;
}

/// HTML of a key with possible line breaks after each underscore.
std::string breakable(const std::string& key) {
  std::string html;
  for (const char c : html_escaped(key)) html += c == '_' ? "_<wbr>" : std::string(1, c);
  return html;
}

std::string tissue_table(const std::vector<Tissue>& tissues) {
  std::vector<const ParameterRow*> columns;  // for each key the first row that has it
  for (const Tissue& tissue : tissues) {
    for (const ParameterRow* row : tissue.rows) {
      const auto same = [&](const ParameterRow* c) { return key_of(*c) == key_of(*row); };
      if (!key_of(*row).empty() && std::none_of(columns.begin(), columns.end(), same)) columns.push_back(row);
    }
  }
  std::string html = "<div class=\"scroll\"><table class=\"parameters\"><thead><tr><th>Tissue</th>";
  for (const ParameterRow* column : columns) {
    html += "<th class=\"number\"><code>" + breakable(key_of(*column)) + "</code>";
    if (!column->unit.empty()) html += "<br>[" + html_escaped(column->unit) + "]";
    html += "</th>";
  }
  html += "<th>Source</th></tr></thead><tbody>";
  for (const Tissue& tissue : tissues) {
    html += "<tr><td>" + html_escaped(readable_name(tissue.region)) + "</td>";
    const bool whole = key_of(*tissue.rows.front()).empty();  // the row describes the whole region, such as "held"
    if (whole) {
      html += "<td colspan=\"" + std::to_string(std::max<std::size_t>(1, columns.size())) + "\">" +
              html_escaped(tissue.rows.front()->value) + "</td>";
    }
    for (const ParameterRow* column : columns) {
      if (whole) break;
      const auto same = [&](const ParameterRow* row) { return key_of(*row) == key_of(*column); };
      const auto row = std::find_if(tissue.rows.begin(), tissue.rows.end(), same);
      html += "<td class=\"number\">" + (row == tissue.rows.end() ? "–" : html_escaped((*row)->value)) + "</td>";
    }
    html += "<td class=\"source\">" + sources_of(tissue) + "</td></tr>";
  }
  return html + "</tbody></table></div>";
}

std::string plain_table(const std::vector<const ParameterRow*>& rows) {
  std::string html =
      "<div class=\"scroll\"><table class=\"parameters\"><thead><tr><th>Parameter</th><th class=\"number\">Value</th>"
      "<th>Unit</th><th>Source</th></tr></thead><tbody>";
  for (const ParameterRow* row : rows) {
    html += "<tr><td><code>" + html_escaped(row->name) + "</code></td><td class=\"number\">" +
            html_escaped(row->value) + "</td><td>" + html_escaped(row->unit) + "</td><td class=\"source\">" +
            html_escaped(row->source) + "</td></tr>";
  }
  return html + "</tbody></table></div>";
}

}  // namespace

std::string parameter_tables(std::span<const ParameterRow> parameters) {
  std::vector<Tissue> tissues;
  std::vector<const ParameterRow*> others;
  for (const ParameterRow& row : parameters) {
    if (!is_tissue(row)) {
      others.push_back(&row);
      continue;
    }
    const std::string region = region_of(row);
    auto known = std::find_if(tissues.begin(), tissues.end(), [&](const Tissue& t) { return t.region == region; });
    if (known == tissues.end()) known = tissues.insert(tissues.end(), {region, {}});
    known->rows.push_back(&row);
  }
  std::string html;
  if (!tissues.empty()) html += "<h3>Tissue</h3>" + tissue_table(tissues);
  if (!others.empty()) html += "<h3>Needle, coupling and run</h3>" + plain_table(others);
  return html;
}

}  // namespace stylet::results
