// SPDX-License-Identifier: GPL-3.0-or-later
#include "structure_choice.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace stylet {
namespace meshing {
namespace {

std::vector<Candidate> candidates_of(const LabelImage& image) {
  std::map<int, bool> there;  // label → has voxels
  for (const auto& [label, name] : image.names) there[label] = false;
  for (const auto label : image.labels) {
    if (label != 0) there[label] = true;
  }
  std::vector<Candidate> all;
  for (const auto& [label, has_voxels] : there) {
    const auto name = image.names.find(label);
    const auto meaning = image.meanings.find(label);
    const std::string number = std::to_string(label);
    all.push_back({.name = name == image.names.end() || name->second.empty() ? number : name->second,
                   .meaning = meaning == image.meanings.end() ? "" : meaning->second,
                   .number = label,
                   .type = "",
                   .word = number,
                   .nothing = has_voxels ? "" : "empty"});
  }
  return all;
}

/// Where the user names none, every label is a region, under the name that the file gives it or its number.
void keep_the_others(std::vector<StructureUse>& uses, const std::vector<Candidate>& candidates) {
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (!candidates[i].nothing.empty() || !uses[i].region.empty() || uses[i].why != kNotRecognised) continue;
    const bool nameless = candidates[i].name == candidates[i].word;
    uses[i].region = nameless ? fmt::format("label_{}", uses[i].number) : uses[i].name;
    uses[i].why.clear();
  }
}

/// All of the gland as one region; of a mask without a target everything is the gland.
void keep_gland_labels(std::vector<StructureUse>& uses) {
  const bool has_target =
      std::any_of(uses.begin(), uses.end(), [](const auto& u) { return is_target_region(u.region); });
  for (StructureUse& use : uses) {
    if (use.region.empty()) continue;
    if (!has_target || is_target_region(use.region)) {
      use.region = "prostate";
    } else {
      leave_out(use, kPaperTakesTheGland);
    }
  }
}

}  // namespace
}  // namespace meshing

Result<StructureChoice> choose_structures(const LabelImage& image, const MeshOptions& options) {
  const auto candidates = meshing::candidates_of(image);
  const std::string source = image.source.empty() ? "label mask" : image.source;
  auto uses = meshing::decide(candidates, options, source, "label", true);
  if (!uses) return uses.error();
  if (options.regions.empty()) meshing::keep_the_others(*uses, candidates);
  const bool has_target =
      std::any_of(uses->begin(), uses->end(), [](const StructureUse& u) { return is_target_region(u.region); });
  if (options.preset == MeshPreset::paper) meshing::keep_gland_labels(*uses);
  StructureChoice choice = meshing::told(*std::move(uses), candidates, "label");
  choice.has_target = has_target;
  return choice;
}

}  // namespace stylet
