// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/map_section.hpp"

#include "fixed_number.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

namespace stylet::results {
namespace {

std::string map_cell(const std::optional<double>& mm, int digits) {
  return "<td class=\"number\">" + (mm ? fixed(*mm, digits) : "–") + "</td>";
}

std::optional<double> length(const std::optional<Vec3>& v) { return v ? std::optional(v->norm()) : std::nullopt; }

std::string rows(const HoleMap& map) {
  constexpr int kWayDigits = 1;    // lengths along straight ways [mm]
  constexpr int kShiftDigits = 2;  // predicted shifts [mm]
  std::string html;
  for (const HoleRow& row : map.holes) {
    const bool has_way = row.depth_mm > 0.0;
    const Prediction prediction = row.prediction.value_or(Prediction{});
    std::vector<std::string> remarks = prediction.remarks;
    if (!row.failed.empty()) remarks.push_back(row.failed);
    html += fmt::format("<tr{}><td>{}</td>", row.hole == map.planned ? " class=\"planned\"" : "",
                        html_escaped(row.hole) + (row.hole == map.planned ? " (planned)" : ""));
    html += map_cell(has_way ? std::optional(row.depth_mm) : std::nullopt, kWayDigits);
    html += map_cell(has_way ? std::optional(row.in_target_mm) : std::nullopt, kWayDigits);
    for (const auto& clearance : row.clearance_mm) html += map_cell(clearance, kWayDigits);
    const HoleEffect effect = effect_of(row);
    for (const auto& vector : {effect.shift_at_break_mm, effect.shift_max_mm, effect.tip_error_mm})
      html += map_cell(length(vector), kShiftDigits);
    if (!map.in_place.empty()) html += map_cell(length(prediction.tip_error_mm), kShiftDigits);
    html += "<td>" + html_prose(fmt::format("{}", fmt::join(remarks, " "))) + "</td></tr>";
  }
  return html;
}

std::string tell_missing(const HoleMap& map) {
  std::string text;
  for (const Spared structure : missing_structures(map))
    text += fmt::format(" There is no {} in this model.", to_string(structure));
  return text;
}

/// Which needles are in place, what they have done to the gland, and from where the figures count.
std::string tell_in_place(const HoleMap& map) {
  if (map.in_place.empty()) return {};
  std::string text = fmt::format(
      "Needles are in place in the {} {} (procedure.stabilising): they went in first and stay, and the needle through "
      "each other hole goes in beside them. Shifts count from the gland as they hold it",
      map.in_place.size() == 1 ? "hole" : "holes", fmt::join(map.in_place, ", "));
  const NeedlesInPlace* held = needles_in_place(map);
  if (held != nullptr && held->shift_mm)
    text += fmt::format(", {:.2f} mm from its place at rest", held->shift_mm->norm());
  text +=
      ". How far the tip is off its target counts from the tissue that lies at the planned place while they are in, "
      "and, in the last "
      "column "
      "of numbers, from the tissue that was planned, in a patient that nothing has moved.";
  if (held != nullptr && !held->remarks.empty()) text += " " + fmt::format("{}", fmt::join(held->remarks, " "));
  return "<p>" + html_prose(text) + "</p>";
}

}  // namespace

std::string map_section(const HoleMap& map) {
  return "<section aria-labelledby=\"map\"><h2 id=\"map\">A map before the needle</h2><p>" +
         html_prose(fmt::format(
             "For each hole of the template, the map shows how near the straight way comes to organs, and what a "
             "needle through the hole does: the same needle was inserted through each of the {} holes that lead into "
             "the gland. The straight way of the other {} misses the gland; they are small dots. In every picture a "
             "dark colour is a warning, and the number is the value in millimetres.",
             map.holes.size(), map.missing)) +
         html_escaped(tell_missing(map)) + "</p>" + tell_in_place(map) +
         "<p>Seen from the patient’s feet: the patient’s right is on the left, anterior is up. The planned hole "
         "has a frame. Hold the pointer over a hole to see all its values.</p><div class=\"templates needs-script\" "
         "id=\"map-pictures\"></div><details open><summary>All numbers</summary><div class=\"scroll "
         "tall-table\"><table class=\"parameters map\"><thead><tr><th rowspan=\"2\">Hole</th><th class=\"number\" "
         "rowspan=\"2\">Depth [mm]</th><th class=\"number\" rowspan=\"2\">In the gland [mm]</th><th "
         "colspan=\"3\">Clearance [mm] to</th><th colspan=\"2\">Shift of the gland [mm]</th><th class=\"number\" "
         "rowspan=\"2\">Tip off its target [mm]</th>" +
         std::string(map.in_place.empty() ? ""
                                          : "<th class=\"number\" rowspan=\"2\">Tip off the planned tissue [mm]</th>") +
         "<th rowspan=\"2\">Remark</th></tr><tr><th class=\"number\">bone</th><th "
         "class=\"number\">urethra</th><th class=\"number\">rectum</th><th class=\"number\">at break</th><th "
         "class=\"number\">at most</th></tr></thead><tbody>" +
         rows(map) +
         "</tbody></table></div></details><p><em>Clearance</em> is the distance between the needle’s surface and the "
         "structure, along the whole straight way from the skin to the planned tip; 0 means that the way touches or "
         "crosses it. <em>Shift</em> is the shift of the gland as a whole, just before its capsule breaks and at its "
         "largest on the way in. <em>Tip off its target</em> is the distance in the tissue between the planned and the "
         "actual "
         "place of the tip at its deepest. A dash means that there is no value. The same numbers are in "
         "<code>map.csv</code>. Do not plan or judge a treatment by this map.</p></section>";
}

}  // namespace stylet::results
