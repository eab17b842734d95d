// SPDX-License-Identifier: GPL-3.0-or-later
#include "describe.hpp"
#include "table.hpp"

#include "stylet/mesher/structures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace stylet::cli {

namespace {

struct Label {
  std::int64_t voxels = 0;
  Eigen::AlignedBox3d box;  ///< [mm] LPS, of the voxel centres
};

std::map<int, Label> labels_of(const LabelImage& image) {
  std::map<int, Label> labels;
  std::size_t voxel = 0;
  for (Index k = 0; k < image.size[2]; ++k) {
    for (Index j = 0; j < image.size[1]; ++j) {
      for (Index i = 0; i < image.size[0]; ++i, ++voxel) {
        const int value = image.labels[voxel];
        if (value == 0) continue;
        Label& label = labels[value];
        ++label.voxels;
        label.box.extend(image.voxel_centre(i, j, k));
      }
    }
  }
  return labels;
}

std::string text_of(const std::map<int, std::string>& texts, int label) {
  const auto found = texts.find(label);
  return found == texts.end() ? "" : found->second;
}

}  // namespace

Description describe(const LabelImage& image) {
  const double voxel_cc = image.spacing.prod() / 1000;
  const bool left_handed = image.direction.determinant() < 0;
  // Angle between the slices' normal and the nearest patient axis.
  const double tilt_deg =
      std::acos(std::min(1.0, image.direction.col(2).cwiseAbs().maxCoeff())) * 180 / std::numbers::pi;

  Description out;
  Json direction = Json::array();
  for (int row = 0; row < 3; ++row) {
    direction.push_back({image.direction(row, 0), image.direction(row, 1), image.direction(row, 2)});
  }
  out.json = {{"kind", "mask"},
              {"size", image.size},
              {"spacing_mm", {image.spacing.x(), image.spacing.y(), image.spacing.z()}},
              {"origin_mm", {image.origin.x(), image.origin.y(), image.origin.z()}},
              {"direction", direction},
              {"left_handed", left_handed},
              {"slice_tilt_deg", tilt_deg},
              {"labels", Json::array()}};

  std::map<int, std::string> taken_as;
  const StructureChoice choice = *choose_structures(image, {});  // fails only for invalid options, and there are none
  for (const StructureUse& use : choice.uses) taken_as[use.number] = use.region;

  Table table({"label", "name", "taken as", "voxels", "extent mm", "volume cc"});
  for (const auto& [value, label] : labels_of(image)) {
    const std::string name = text_of(image.names, value), meaning = text_of(image.meanings, value);
    const double volume_cc = static_cast<double>(label.voxels) * voxel_cc;
    out.json["labels"].push_back({{"label", value},
                                  {"name", name},
                                  {"meaning", meaning},
                                  {"taken_as", taken_as[value]},
                                  {"voxels", label.voxels},
                                  {"extent_mm", extent_json(label.box)},
                                  {"volume_cc", volume_cc}});
    const std::string& region = taken_as[value];
    table.row({fmt::to_string(value), name.empty() ? meaning : name, region.empty() ? "(left out)" : region,
               fmt::to_string(label.voxels), extent_text(label.box), fmt::format("{:.1f}", volume_cc)});
  }

  Facts facts;
  facts.add("kind", fmt::format("label mask with {} label{}", out.json["labels"].size(),
                                out.json["labels"].size() == 1 ? "" : "s"));
  facts.add("voxels", fmt::format("{} × {} × {}", image.size[0], image.size[1], image.size[2]));
  facts.add("spacing",
            fmt::format("{:.4g} × {:.4g} × {:.4g} mm", image.spacing.x(), image.spacing.y(), image.spacing.z()));
  facts.add("frame", fmt::format("{}, slices tilted by {:.1f}° against the patient's axes",
                                 left_handed ? "left-handed" : "right-handed", tilt_deg));
  out.text = facts.text() + "\n\n" + table.text();
  std::vector<std::string> notes = image.notes;
  notes.insert(notes.end(), choice.notes.begin(), choice.notes.end());
  for (const std::string& note : notes) out.text += "\n  note: " + note;
  out.json["notes"] = notes;
  return out;
}

}  // namespace stylet::cli
