// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_text.hpp"

#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::cli {

namespace {

constexpr const char* kNone = "-";

std::string tenths(const std::optional<double>& mm) { return mm ? fmt::format("{:.1f}", *mm) : kNone; }

std::string hundredths(const std::optional<Vec3>& mm) { return mm ? fmt::format("{:.2f}", mm->norm()) : kNone; }

/// Structures that no row has a clearance to: "bone and urethra"; empty where all are there.
std::string missing_structures(const HoleMap& map) {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < kSpared.size(); ++i) {
    const bool known = std::any_of(map.holes.begin(), map.holes.end(),
                                   [i](const HoleRow& row) { return row.clearance_mm[i].has_value(); });
    if (!known) missing.emplace_back(to_string(kSpared[i]));
  }
  return fmt::format("{}", fmt::join(missing, " and no "));
}

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
          "Map of the template, before the needle (all in mm; * the planned hole). {} of {} holes lead into "
          "the gland; the straight way of the other {} misses it.\n",
          map.holes.size(), map.columns.size() * map.rows.size(), map.missing) +
      table.text() +
      "\n\n  to bone, urethra, rectum: between the needle's surface on its straight way and the structure; 0 is "
      "through "
      "it"
      "\n  shift: how far the gland as a whole has moved just before its capsule breaks, and at most on the way in"
      "\n  tip error: from where the tip was to be in the tissue at its deepest to where it is";
  if (const std::string missing = missing_structures(map); !missing.empty())
    text += "\n  There is no " + missing + " in this model.";
  if (!remarks.empty()) text += "\n\nRemarks" + remarks;
  return text + "\n\nNot a medical device: do not plan or judge a treatment by this map.";
}

}  // namespace stylet::cli
