// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::meshing {
namespace {

struct Choice {
  const Roi* roi;
  std::string region;
};

std::vector<std::string> names_of(const ContourSet& set) {
  std::vector<std::string> names;
  for (const Roi& r : set.rois) names.push_back(r.contours.empty() ? r.name + " (empty)" : r.name);
  return names;
}

/// Which ROIs are meshed, and as what.
Result<std::vector<Choice>> choose(const ContourSet& set, const MeshOptions& options, std::vector<std::string>& notes) {
  std::vector<Choice> chosen;
  if (!options.regions.empty()) {
    for (const auto& [name, region] : options.regions) {
      const auto roi = std::find_if(set.rois.begin(), set.rois.end(), [&](const Roi& r) { return r.name == name; });
      if (roi == set.rois.end()) {
        return input_error(set.source, fmt::format("there is no ROI '{}'; the file has {}", name, names_of(set)),
                           "name one of these");
      }
      if (roi->contours.empty()) {
        return input_error(fmt::format("{}, ROI '{}'", set.source, name), "the ROI has no contours",
                           "leave it out or choose another");
      }
      const std::string canonical = canonical_region(region);
      chosen.push_back({&*roi, canonical.empty() ? region : canonical});
    }
  } else {
    std::vector<std::string> passed;
    for (const Roi& roi : set.rois) {
      const std::string region = canonical_region(roi.name);
      if (roi.contours.empty()) continue;  // the reader has noted it
      if (region.empty()) {
        passed.push_back(roi.name);
      } else {
        chosen.push_back({&roi, region});
      }
    }
    if (!passed.empty()) notes.push_back(fmt::format("structures passed over, name not recognised: {}", passed));
    // A planning volume stands in for the gland only where the gland itself was not drawn; CTV is nearest to it.
    std::string keep;
    const auto has = [&](std::string_view name) {
      return std::any_of(chosen.begin(), chosen.end(), [&](const Choice& c) { return c.region == name; });
    };
    if (!has("prostate") && !has("peripheral_zone") && !has("transition_zone")) {
      keep = has("ctv") ? "ctv" : has("ptv") ? "ptv" : "gtv";
    }
    std::erase_if(chosen, [&](const Choice& c) {
      const bool planning = c.region == "ptv" || c.region == "ctv" || c.region == "gtv";
      if (planning && c.region == keep) {
        notes.push_back(fmt::format("no prostate contours: '{}' stands in as the target", c.roi->name));
      } else if (planning) {
        notes.push_back(fmt::format("'{}' is a planning volume, not anatomy: passed over", c.roi->name));
      }
      return planning && c.region != keep;
    });
  }
  if (std::none_of(chosen.begin(), chosen.end(), [](const Choice& c) { return is_target_region(c.region); })) {
    return input_error(set.source,
                       fmt::format("no target structure: none of {} is recognised as prostate, prostate zone, "
                                   "CTV, PTV or GTV",
                                   names_of(set)),
                       "say which one is the target, e.g. map its name to 'prostate'");
  }
  if (options.preset == MeshPreset::paper) {
    std::erase_if(chosen, [](const Choice& c) { return !is_target_region(c.region) && c.region != "band"; });
  }
  std::stable_sort(chosen.begin(), chosen.end(),
                   [](const Choice& a, const Choice& b) { return priority(a.region) < priority(b.region); });
  return chosen;
}

/// The structure of one ROI.
Result<Structure> structure_of(const Roi& roi, const std::string& region, const SliceFrame& frame,
                               const MeshOptions& options, Anatomy& anatomy) {
  const std::string where = fmt::format("{}, ROI '{}'", anatomy.source, roi.name);
  Structure s;
  s.name = region;
  s.target = is_target_region(region);
  std::vector<Contour> culled;
  for (const Contour& c : roi.contours) {
    for (const Vec3& p : c.points) {
      if (!p.allFinite()) return input_error(where, "a contour point is not a finite number", "export it again");
    }
    anatomy.contour_points += static_cast<Index>(c.points.size());
    culled.push_back(cull(c, options.cull_tolerance_mm));
    anatomy.contour_points_kept += static_cast<Index>(culled.back().points.size());
    for (const Vec3& p : culled.back().points) s.boundary.push_back(p);
  }
  const std::vector<Slice> original = to_slices(roi.contours, frame);
  const std::vector<Slice> slices = to_slices(culled, frame);
  if (slices.size() < 2) {
    return input_error(where, fmt::format("contours on {} slice; a solid needs at least two", slices.size()),
                       "contour it on more slices or leave it out");
  }
  const std::vector<double> thickness = slice_thickness(original);
  double largest = 0;
  for (std::size_t i = 0; i < original.size(); ++i) {
    s.input_volume += original[i].area() * thickness[i];
    largest = std::max(largest, original[i].area());
  }
  if (!(s.input_volume > 1.0)) {
    return input_error(where, fmt::format("the contours enclose {:.3g} mm³", s.input_volume),
                       "check the units (mm expected) and the contours");
  }
  // Grid fine enough for the structure, within bounds of memory; smoothing well below its thickness.
  const double radius = std::sqrt(largest / std::numbers::pi);
  const double voxel = std::clamp(radius / 20, 0.5, 3.0);
  const bool body = region == "body";
  const double sigma = body ? voxel : std::min(1.2, 0.08 * radius);
  const double rounding = body ? std::min(15.0, 0.2 * radius) : 0.0;
  s.shape = interpolate_slices(slices, frame, voxel, sigma, rounding);
  return s;
}

}  // namespace

Result<Anatomy> anatomy_of(const ContourSet& set, const MeshOptions& options, const Progress& progress) {
  Anatomy anatomy;
  anatomy.source = set.source.empty() ? "contours" : set.source;
  anatomy.notes = set.notes;
  if (set.rois.empty()) {
    return input_error(anatomy.source, "the contour set has no structures", "export it with the structures' contours");
  }
  auto chosen = choose(set, options, anatomy.notes);
  if (!chosen) return chosen.error();
  std::vector<const Roi*> rois;
  for (const Choice& c : *chosen) rois.push_back(c.roi);
  auto frame = common_frame(set, rois);
  if (!frame) return frame.error();
  std::string last;
  for (std::size_t i = 0; i < chosen->size(); ++i) {
    const auto& [roi, region] = (*chosen)[i];
    report(progress, "interpolating contours", static_cast<double>(i) / static_cast<double>(chosen->size()));
    auto s = structure_of(*roi, region, *frame, options, anatomy);
    if (!s) return s.error();
    if (region == last) {
      anatomy.notes.push_back(fmt::format("'{}' is a second {}: passed over", roi->name, region));
      continue;
    }
    last = region;
    anatomy.add(*std::move(s));
  }
  return anatomy;
}

}  // namespace stylet::meshing
