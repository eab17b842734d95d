// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi_choice.hpp"

#include "anatomy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

namespace stylet::meshing {
namespace {

using Choices = std::vector<RoiChoice>;

bool has(const Choices& chosen, std::string_view region) {
  return std::any_of(chosen.begin(), chosen.end(), [&](const RoiChoice& c) { return c.region == region; });
}

std::vector<std::string> names_of(const ContourSet& set) {
  std::vector<std::string> names;
  for (const Roi& r : set.rois) names.push_back(r.contours.empty() ? r.name + " (empty)" : r.name);
  return names;
}

Result<Choices> as_asked(const ContourSet& set, const MeshOptions& options) {
  Choices chosen;
  for (const auto& [name, region] : options.regions) {
    const auto roi = std::find_if(set.rois.begin(), set.rois.end(), [&](const Roi& r) { return r.name == name; });
    if (roi == set.rois.end()) {
      return input_error(set.source, fmt::format("there is no ROI '{}'; the file has {}", name, names_of(set)),
                         "name one of these");
    }
    if (roi->contours.empty()) {
      return input_error(fmt::format("{}, ROI '{}'", set.source, name), "the ROI has no closed contours",
                         "leave it out or choose another");
    }
    const std::string canonical = canonical_region(region);
    chosen.push_back({&*roi, canonical.empty() ? region : canonical});
  }
  return chosen;
}

Choices by_name(const ContourSet& set, std::vector<std::string>& notes) {
  Choices chosen;
  std::vector<std::string> passed;
  for (const Roi& roi : set.rois) {
    if (roi.contours.empty()) continue;  // the reader has noted it
    const std::string region = canonical_region(roi.name);
    if (region.empty()) {
      passed.push_back(roi.name);
    } else {
      chosen.push_back({&roi, region});
    }
  }
  if (!passed.empty()) notes.push_back(fmt::format("structures passed over, name not recognised: {}", passed));
  // A planning volume stands in for the gland only where the gland itself was not drawn; the CTV is nearest to it.
  std::string keep;
  if (!has(chosen, "prostate") && !has(chosen, "peripheral_zone") && !has(chosen, "transition_zone")) {
    keep = has(chosen, "ctv") ? "ctv" : has(chosen, "ptv") ? "ptv" : "gtv";
  }
  bool found = false;
  std::erase_if(chosen, [&](const RoiChoice& c) {
    if (c.region != "ptv" && c.region != "ctv" && c.region != "gtv") return false;
    if (c.region == keep && !found) {
      found = true;
      notes.push_back(fmt::format("no prostate contours: '{}' stands in as the target", c.roi->name));
      return false;
    }
    notes.push_back(fmt::format("'{}' is a planning volume, not anatomy: passed over", c.roi->name));
    return true;
  });
  return chosen;
}

}  // namespace

Result<Choices> choose_rois(const ContourSet& set, const MeshOptions& options, std::vector<std::string>& notes) {
  Choices chosen;
  if (options.regions.empty()) {
    chosen = by_name(set, notes);
  } else {
    auto asked = as_asked(set, options);
    if (!asked) return asked.error();
    chosen = *std::move(asked);
  }
  if (std::none_of(chosen.begin(), chosen.end(), [](const RoiChoice& c) { return is_target_region(c.region); })) {
    return input_error(set.source,
                       fmt::format("no target structure: none of {} is recognised as prostate, prostate zone, CTV, PTV "
                                   "or GTV",
                                   names_of(set)),
                       "say which one is the target, that is, map its name to 'prostate'");
  }
  if (options.preset == MeshPreset::paper) {
    // The gland in one piece, and what holds it.
    const bool whole = has(chosen, "prostate");
    std::erase_if(chosen, [&](const RoiChoice& c) {
      return c.region != "band" && (whole ? c.region != "prostate" : !is_target_region(c.region));
    });
    for (RoiChoice& c : chosen) {
      if (!whole && c.region.ends_with("_zone")) c.region = "prostate";
    }
  }
  std::stable_sort(chosen.begin(), chosen.end(), [](const RoiChoice& a, const RoiChoice& b) {
    return std::pair(priority(a.region), a.region) < std::pair(priority(b.region), b.region);
  });
  return chosen;
}

}  // namespace stylet::meshing
