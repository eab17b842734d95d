// SPDX-License-Identifier: GPL-3.0-or-later
// Writer of contour JSON (docs/formats.md).
#include "stylet/core/json_text.hpp"
#include "stylet/io/contours_io.hpp"
#include "stylet/io/files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace stylet {

Result<> write_contour_json(const ContourSet& contours, const std::filesystem::path& path) {
  using Json = nlohmann::ordered_json;
  // One contour per line, which is compact, readable in an editor, and gives short differences in version control.
  std::string text = "{\n";
  const auto quoted = [](const std::string& s) { return json_text(Json(s)); };
  text += "  \"format\": \"stylet-contours\",\n  \"version\": 1,\n  \"units\": \"mm\",\n  \"frame\": \"LPS\",\n";
  text += fmt::format("  \"label\": {},\n  \"frame_of_reference\": {},\n  \"structures\": [", quoted(contours.label),
                      quoted(contours.frame_of_reference));
  bool first_roi = true;
  for (const Roi& roi : contours.rois) {
    text += fmt::format("{}\n    {{\n      \"name\": {},\n      \"number\": {},\n      \"type\": {},\n",
                        first_roi ? "" : ",", quoted(roi.name), roi.number, quoted(roi.type));
    text += fmt::format("      \"colour\": [{}, {}, {}],\n      \"contours\": [", roi.colour[0], roi.colour[1],
                        roi.colour[2]);
    first_roi = false;
    bool first_contour = true;
    for (const Contour& contour : roi.contours) {
      text += first_contour ? "\n        [" : ",\n        [";
      first_contour = false;
      for (std::size_t i = 0; i < contour.points.size(); ++i) {
        const Vec3& p = contour.points[i];
        if (!p.allFinite()) {
          return failure(path.string(), fmt::format("structure '{}' has a point that is not finite", roi.name),
                         "Correct the contours before writing them");
        }
        text += fmt::format("{}[{}, {}, {}]", i == 0 ? "" : ", ", p.x(), p.y(), p.z());
      }
      text += ']';
    }
    text += "\n      ]\n    }";
  }
  text += "\n  ]\n}\n";
  return write_whole_file(path, text);
}

}  // namespace stylet
