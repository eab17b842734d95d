// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_text.hpp"

#include "table.hpp"

#include <fmt/format.h>

namespace stylet::cli {

namespace {

constexpr const char* kNone = "-";

std::string tenths(const std::optional<double>& mm) { return mm ? fmt::format("{:.1f}", *mm) : kNone; }

std::string hundredths(const std::optional<Vec3>& mm) { return mm ? fmt::format("{:.2f}", mm->norm()) : kNone; }

/// Which needles are in place, what they have done to the gland, and from where the figures count.
std::string in_place_text(const HoleMap& map) {
  std::string text = fmt::format(
      "\nNeedles are in place in the {} {} (procedure.stabilising); the needle through each other hole goes in beside "
      "them.\n  shift: counts from the gland as they hold it",
      map.in_place.size() == 1 ? "hole" : "holes", fmt::join(map.in_place, ", "));
  const NeedlesInPlace* held = needles_in_place(map);
  if (held != nullptr && held->shift_mm) {
    const Vec3& mm = *held->shift_mm;
    text += fmt::format(", {:.2f} mm (left {:.2f}, posterior {:.2f}, superior {:.2f}) from its place at rest",
                        mm.norm(), mm.x(), mm.y(), mm.z());
  }
  text +=
      "\n  tip off target: counts from the tissue that lies at the planned place while they are in; from the plan: "
      "from the "
      "tissue that was planned, in a patient that nothing has moved";
  for (const std::string& remark : held != nullptr ? held->remarks : std::vector<std::string>{})
    text += "\n  " + remark;
  return text;
}

}  // namespace

std::string map_text(const HoleMap& map) {
  std::vector<std::string> heads{"hole",      "depth [mm]",     "in gland",      "to bone",       "to urethra",
                                 "to rectum", "shift at break", "shift at most", "tip off target"};
  const bool beside = !map.in_place.empty();
  if (beside) heads.emplace_back("from the plan");
  Table table(heads);
  std::string remarks;
  for (const HoleRow& row : map.holes) {
    const std::string name = row.hole == map.planned ? row.hole + " *" : row.hole;
    if (!row.failed.empty()) remarks += fmt::format("\n  {}: {}", row.hole, row.failed);
    const Prediction prediction = row.prediction.value_or(Prediction{});
    for (const std::string& remark : prediction.remarks) remarks += fmt::format("\n  {}: {}", row.hole, remark);
    std::vector<std::string> cells{name};
    const bool has_way = row.depth_mm > 0.0;
    cells.push_back(has_way ? tenths(row.depth_mm) : kNone);
    cells.push_back(has_way ? tenths(row.in_target_mm) : kNone);
    for (const auto& clearance : row.clearance_mm) cells.push_back(tenths(clearance));
    const HoleEffect effect = effect_of(row);
    for (const auto& vector : {effect.shift_at_break_mm, effect.shift_max_mm, effect.tip_error_mm})
      cells.push_back(hundredths(vector));
    if (beside) cells.push_back(hundredths(prediction.tip_error_mm));
    table.row(std::move(cells));
  }
  std::string text =
      fmt::format(
          "Map of the template, predicted before an insertion (all in mm; * marks the planned hole). {} of {} holes "
          "lead into the gland; the straight path from the other {} misses it.\n",
          map.holes.size(), map.columns.size() * map.rows.size(), map.missing) +
      table.text() +
      "\n\n  to bone, urethra, rectum: distance between the needle's surface on its straight path and the structure; 0 "
      "means that the path goes through the structure"
      "\n  shift: displacement of the gland as a whole just before its capsule breaks, and its maximum during insertion"
      "\n  tip off target: distance in the tissue between the planned and the actual position of the tip at its "
      "deepest";
  if (beside) text += "\n" + in_place_text(map);
  for (const Spared structure : missing_structures(map))
    text += fmt::format("\n  There is no {} in this model.", to_string(structure));
  if (!remarks.empty()) text += "\n\nRemarks on single holes" + remarks;
  return text + "\n\nNot a medical device: do not plan or judge a treatment by this map.";
}

}  // namespace stylet::cli
