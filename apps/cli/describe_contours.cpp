// SPDX-License-Identifier: GPL-3.0-or-later
#include "contour_measures.hpp"
#include "describe.hpp"
#include "table.hpp"

#include "stylet/io/contours_io.hpp"
#include "stylet/mesher/structures.hpp"

#include <fmt/format.h>

namespace stylet::cli {

Description describe(const ContourSet& contours) {
  Description out;
  out.json = {{"kind", "contours"},
              {"label", contours.label},
              {"frame_of_reference", contours.frame_of_reference},
              {"structures", Json::array()}};
  Table table(
      {"structure", "taken as", "type", "slices", "contours", "points", "spacing mm", "extent mm", "volume cc"});
  std::vector<std::string> notes = contours.notes;
  const StructureChoice choice =
      *choose_structures(contours, {});  // fails only for invalid options, and there are none
  auto use = choice.uses.begin();
  for (const Roi& roi : contours.rois) {
    if (const Result<> sound = check_roi(roi, contours.source); !sound) notes.push_back(sound.error().message());
    if (auto note = long_closing_side(roi)) notes.push_back(*std::move(note));
    const RoiMeasures size = measure(roi);
    const std::string region = roi.contours.empty() ? "" : (use++)->region;
    out.json["structures"].push_back({{"name", roi.name},
                                      {"number", roi.number},
                                      {"type", roi.type},
                                      {"taken_as", region},
                                      {"slices", size.slices},
                                      {"contours", roi.contours.size()},
                                      {"points", size.points},
                                      {"slice_spacing_mm", size.slice_spacing_mm},
                                      {"extent_mm", extent_json(size.box)},
                                      {"volume_cc", size.volume_cc}});
    table.row({roi.name, region.empty() ? "(left out)" : region, roi.type, fmt::to_string(size.slices),
               fmt::to_string(roi.contours.size()), fmt::to_string(size.points),
               fmt::format("{:.2f}", size.slice_spacing_mm), extent_text(size.box),
               fmt::format("{:.1f}", size.volume_cc)});
  }
  Facts facts;
  facts.add("kind",
            fmt::format("contours of {} structure{}", contours.rois.size(), contours.rois.size() == 1 ? "" : "s"));
  if (!contours.label.empty()) facts.add("label", contours.label);
  if (!contours.frame_of_reference.empty()) facts.add("frame of reference", contours.frame_of_reference);
  out.text = facts.text() + "\n\n" + table.text();
  notes.insert(notes.end(), choice.notes.begin(), choice.notes.end());
  for (const std::string& note : notes) out.text += "\n  note: " + note;
  out.json["notes"] = notes;
  return out;
}

}  // namespace stylet::cli
