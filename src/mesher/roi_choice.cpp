// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi_choice.hpp"

#include "anatomy.hpp"
#include "structure_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

namespace stylet {
namespace meshing {
namespace {

std::vector<Candidate> candidates_of(const ContourSet& set) {
  std::vector<Candidate> all;
  for (const Roi& roi : set.rois) {
    all.push_back({.name = roi.name,
                   .meaning = "",
                   .number = roi.number,
                   .type = roi.type,
                   .word = "",
                   .nothing = roi.contours.empty() ? kEmpty : ""});
  }
  for (const PassedOver& passed : set.passed_over) {
    all.push_back({.name = passed.name, .meaning = "", .number = 0, .type = "", .word = "", .nothing = passed.why});
  }
  return all;
}

/// Keeps the gland, as one region, and the band, and leaves out the rest.
void keep_gland_contours(std::vector<StructureUse>& uses) {
  const bool whole = std::any_of(uses.begin(), uses.end(), [](const auto& u) { return u.region == "prostate"; });
  for (StructureUse& use : uses) {
    if (use.region.empty() || use.region == "band") continue;
    if (whole ? use.region != "prostate" : !is_target_region(use.region)) leave_out(use, kPaperTakesTheGland);
    if (!whole && use.region.ends_with("_zone")) use.region = "prostate";
  }
}

}  // namespace

Result<std::vector<RoiChoice>> choose_rois(const ContourSet& set, const MeshOptions& options,
                                           std::vector<std::string>& notes) {
  const auto choice = choose_structures(set, options);
  if (!choice) return choice.error();
  if (!choice->has_target) {
    std::vector<std::string> names;
    for (const StructureUse& use : choice->uses) names.push_back(use.name);
    for (const StructureUse& use : choice->empty) names.push_back(fmt::format("{} ({})", use.name, use.why));
    return input_error(
        set.source,
        fmt::format("no target structure: none of {} is recognised as prostate, prostate zone, CTV, PTV or GTV", names),
        "Map the name of the target to 'prostate' below [patient.regions]");
  }
  notes.insert(notes.end(), choice->notes.begin(), choice->notes.end());
  std::vector<const Roi*> drawn;  // the ROIs of choice->uses
  for (const Roi& roi : set.rois) {
    if (!roi.contours.empty()) drawn.push_back(&roi);
  }
  std::vector<RoiChoice> chosen;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (!choice->uses[i].region.empty()) chosen.push_back({drawn[i], choice->uses[i].region});
  }
  std::stable_sort(chosen.begin(), chosen.end(), [](const RoiChoice& a, const RoiChoice& b) {
    return std::pair(priority(a.region), a.region) < std::pair(priority(b.region), b.region);
  });
  return chosen;
}

}  // namespace meshing

Result<StructureChoice> choose_structures(const ContourSet& contours, const MeshOptions& options) {
  const auto candidates = meshing::candidates_of(contours);
  const std::string source = contours.source.empty() ? "contours" : contours.source;
  auto uses = meshing::decide(candidates, options, source, "structure", false);
  if (!uses) return uses.error();
  if (options.preset == MeshPreset::paper) meshing::keep_gland_contours(*uses);
  return meshing::told(*std::move(uses), candidates, "structure");
}

}  // namespace stylet
