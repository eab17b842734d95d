// SPDX-License-Identifier: GPL-3.0-or-later
#include "structure_choice.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <map>
#include <set>

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
                   .nothing = has_voxels ? "" : kEmpty});
  }
  return all;
}

/// Used where the user assigns no region: every other label becomes a region with its name in the file or its number.
void keep_the_others(std::vector<StructureUse>& uses, const std::vector<Candidate>& candidates) {
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (!candidates[i].nothing.empty() || !uses[i].region.empty() || uses[i].why != kNotRecognised) continue;
    const bool nameless = candidates[i].name == candidates[i].word;
    uses[i].region = nameless ? fmt::format("label_{}", uses[i].number) : uses[i].name;
    uses[i].why.clear();
  }
}

/// Areas [mm²] of contact of some labels: (label, neighbour's label) → area. Beyond the edge of the image is
/// background.
std::map<std::pair<int, int>, double> contact_areas(const LabelImage& image, const std::set<int>& labels) {
  std::map<std::pair<int, int>, double> areas;
  std::vector<bool> matters(std::size_t{1} << 16);
  for (const int label : labels) matters[static_cast<std::size_t>(label)] = true;
  const auto touch = [&](int a, int b, double area) {
    if (a == b) return;
    if (matters[a]) areas[{a, b}] += area;
    if (matters[b]) areas[{b, a}] += area;
  };
  const std::array<std::size_t, 3> step{1, static_cast<std::size_t>(image.size[0]),
                                        static_cast<std::size_t>(image.size[0]) * image.size[1]};
  const Vec3 face = image.spacing.prod() * image.spacing.cwiseInverse();
  std::size_t n = 0;
  for (Index k = 0; k < image.size[2]; ++k) {
    for (Index j = 0; j < image.size[1]; ++j) {
      for (Index i = 0; i < image.size[0]; ++i, ++n) {
        const std::array<Index, 3> voxel{i, j, k};
        for (int a = 0; a < 3; ++a) {
          if (voxel[a] == 0) touch(image.labels[n], 0, face[a]);
          const bool last = voxel[a] + 1 == image.size[a];
          touch(image.labels[n], last ? 0 : image.labels[n + step[a]], face[a]);
        }
      }
    }
  }
  return areas;
}

/// The region of the target in which a label lies: by area, it touches more of the target than of anything else, and of
/// the target mostly this region. Empty where it does not lie in the target.
std::string region_around(int label, const std::map<std::pair<int, int>, double>& areas,
                          const std::map<int, std::string>& target) {
  std::map<std::string, double> within;
  double inside = 0, outside = 0;
  for (const auto& [pair, area] : areas) {
    if (pair.first != label) continue;
    const auto region = target.find(pair.second);
    if (region != target.end()) within[region->second] += area;
    (region != target.end() ? inside : outside) += area;
  }
  if (!(inside > outside)) return {};
  const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::max_element(within.begin(), within.end(), less)->first;
}

/// A voxel has only one label: the voxels of a planning volume drawn within the gland belong to the gland, and without
/// them the gland would have a hole. So the planning volume gets the region of the target in which it lies; repeated
/// for planning volumes that lie in such a one.
void fill_the_gland(std::vector<StructureUse>& uses, const LabelImage& image) {
  std::set<int> undecided;
  std::map<int, std::string> target;  // label → region
  for (const StructureUse& use : uses) {
    if (is_target_region(use.region)) target[use.number] = use.region;
    if (use.region.empty() && use.why.starts_with(kPlanningVolume)) undecided.insert(use.number);
  }
  if (undecided.empty() || target.empty()) return;
  const auto areas = contact_areas(image, undecided);
  for (std::size_t before = 0; before != undecided.size();) {
    before = undecided.size();
    for (StructureUse& use : uses) {
      if (!undecided.contains(use.number)) continue;
      const std::string region = region_around(use.number, areas, target);
      if (region.empty()) continue;
      use.region = target[use.number] = region;
      use.why = fmt::format(
          "taken as part of {}, in which it lies, since without this planning volume there would be a hole", region);
      undecided.erase(use.number);
    }
  }
}

/// Makes the whole gland one region and leaves out the rest. In a mask without a target, everything is the gland.
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
  if (image.labels.size() == static_cast<std::size_t>(image.size[0]) * image.size[1] * image.size[2])
    meshing::fill_the_gland(*uses, image);
  const bool has_target =
      std::any_of(uses->begin(), uses->end(), [](const StructureUse& u) { return is_target_region(u.region); });
  if (options.preset == MeshPreset::paper) meshing::keep_gland_labels(*uses);
  StructureChoice choice = meshing::told(*std::move(uses), candidates, "label");
  choice.has_target = has_target;
  return choice;
}

}  // namespace stylet
