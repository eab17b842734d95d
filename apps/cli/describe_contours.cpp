// SPDX-License-Identifier: GPL-3.0-or-later
#include "describe.hpp"
#include "table.hpp"

#include "stylet/patient/judged_contours.hpp"

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
  const JudgedContours judged = *judge_contours(contours, {});  // the only errors are about wishes, and there are none
  for (const JudgedStructure& structure : judged.structures) {
    const Roi& roi = *structure.roi;
    if (structure.fault) notes.push_back(structure.fault->message());
    if (structure.oddity) notes.push_back(*structure.oddity);
    const std::optional<StructureSlices>& slices = structure.slices;
    if (slices && slices->note) notes.push_back(*slices->note);
    Eigen::AlignedBox3d box;
    std::size_t points = 0;
    for (const Contour& contour : roi.contours) {
      points += contour.points.size();
      for (const Vec3& x : contour.points) box.extend(x);
    }
    const auto known = [&](const Json& value) { return slices ? value : Json(); };
    const auto shown = [&](const std::string& text) { return slices ? text : std::string("–"); };
    const std::size_t count = slices ? slices->slices.size() : 0;
    const double gap_mm = slices ? slices->usual_gap_mm : 0;
    const double volume_cc = slices ? slices->volume_mm3() / 1000 : 0;
    const std::string& region = structure.use.region;
    out.json["structures"].push_back({{"name", roi.name},
                                      {"number", roi.number},
                                      {"type", roi.type},
                                      {"taken_as", region},
                                      {"slices", known(count)},
                                      {"contours", roi.contours.size()},
                                      {"points", points},
                                      {"slice_spacing_mm", known(gap_mm)},
                                      {"extent_mm", extent_json(box)},
                                      {"volume_cc", known(volume_cc)}});
    table.row({roi.name, region.empty() ? "(left out)" : region, roi.type, shown(fmt::to_string(count)),
               fmt::to_string(roi.contours.size()), fmt::to_string(points), shown(fmt::format("{:.2f}", gap_mm)),
               extent_text(box), shown(fmt::format("{:.1f}", volume_cc))});
  }
  Facts facts;
  facts.add("kind",
            fmt::format("contours of {} structure{}", contours.rois.size(), contours.rois.size() == 1 ? "" : "s"));
  if (!contours.label.empty()) facts.add("label", contours.label);
  if (!contours.frame_of_reference.empty()) facts.add("frame of reference", contours.frame_of_reference);
  out.text = facts.text() + "\n\n" + table.text();
  notes.insert(notes.end(), judged.choice.notes.begin(), judged.choice.notes.end());
  for (const std::string& note : notes) out.text += "\n  note: " + note;
  out.json["notes"] = notes;
  return out;
}

}  // namespace stylet::cli
