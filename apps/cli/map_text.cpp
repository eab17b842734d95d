// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_text.hpp"

#include "table.hpp"

#include <fmt/format.h>

namespace stylet::cli {

namespace {

constexpr const char* kNone = "-";

std::string tenths(const std::optional<double>& mm) { return mm ? fmt::format("{:.1f}", *mm) : kNone; }

std::string hundredths(const std::optional<Vec3>& mm) { return mm ? fmt::format("{:.2f}", mm->norm()) : kNone; }

}  // namespace

std::string map_text(const HoleMap& map) {
  Table table({"hole", "depth [mm]", "in gland", "to bone", "to urethra", "to rectum", "shift at break",
               "shift at most", "tip error"});
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
    for (const auto& vector : {prediction.shift_at_break_mm, prediction.shift_max_mm, prediction.tip_error_mm})
      cells.push_back(hundredths(vector));
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
      "\n  tip error: distance in the tissue between the planned and the actual position of the tip at its deepest";
  for (const Spared structure : missing_structures(map))
    text += fmt::format("\n  There is no {} in this model.", to_string(structure));
  if (!remarks.empty()) text += "\n\nRemarks on single holes" + remarks;
  return text + "\n\nNot a medical device: do not plan or judge a treatment by this map.";
}

}  // namespace stylet::cli
