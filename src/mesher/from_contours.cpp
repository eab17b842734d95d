// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy.hpp"
#include "body.hpp"
#include "islands.hpp"
#include "roi_choice.hpp"
#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::meshing {
namespace {

constexpr double kWholeGland = 0.85;  // if zones make up this share of the gland, they replace it

/// A polygon of a slice as a contour in space, without the points that cull() drops.
Contour culled(const Polygon& polygon, double height, const SliceFrame& frame, double tolerance_mm) {
  Contour contour;
  for (const Eigen::Vector2d& x : polygon) contour.points.push_back(frame.lps(Vec3(x.x(), x.y(), height)));
  return cull(contour, tolerance_mm);
}

/// The mean of a contour's heights along the slice normal.
double height_of(const Contour& contour, const SliceFrame& frame) {
  double height = 0;
  for (const Vec3& x : contour.points) height += frame.local(x).z() / static_cast<double>(contour.points.size());
  return height;
}

/// Drops the points of all slices that cull() drops. Heights and usual gap are measured anew on the points that are
/// kept: a mesh depends on the last bits of them, and those of regular contours shall stay as they are.
void cull_slices(StructureSlices& stack, double tolerance_mm, Structure& structure, Anatomy& anatomy) {
  std::vector<double> gaps;
  for (StructureSlice& slice : stack.slices) {
    double lowest = HUGE_VAL;
    for (Polygon& polygon : slice.polygons) {
      anatomy.contour_points += static_cast<Index>(polygon.size());
      const Contour kept = culled(polygon, slice.height, stack.frame, tolerance_mm);
      anatomy.contour_points_kept += static_cast<Index>(kept.points.size());
      structure.boundary.insert(structure.boundary.end(), kept.points.begin(), kept.points.end());
      polygon.clear();
      for (const Vec3& x : kept.points) polygon.push_back(stack.frame.local(x).head<2>());
      lowest = std::min(lowest, height_of(kept, stack.frame));
    }
    slice.height = lowest;
    if (&slice != &stack.slices.front()) gaps.push_back(slice.height - (&slice - 1)->height);
  }
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  stack.usual_gap_mm = *middle;
}

/// Makes the structure of one ROI.
Result<Structure> structure_of(const RoiChoice& choice, const SliceFrame& frame, const MeshOptions& options,
                               Anatomy& anatomy) {
  const Roi& roi = *choice.roi;
  const std::string where = fmt::format("{}, ROI '{}'", anatomy.source, roi.name);
  Structure s;
  s.name = choice.region;
  s.target = is_target_region(s.name);
  Result<StructureSlices> meant = structure_slices(roi, anatomy.source, frame);
  if (!meant) return meant.error();
  if (meant->note) anatomy.notes.push_back(*meant->note);
  s.input_volume = meant->volume_mm3();
  s.whole_volume = s.input_volume;
  double largest = 0;
  for (const StructureSlice& slice : meant->slices) largest = std::max(largest, slice.area_mm2);
  cull_slices(*meant, options.cull_tolerance_mm, s, anatomy);
  if (!(s.input_volume > 1.0)) {
    return input_error(where, fmt::format("the contours enclose {:.3g} mm³, expected more than 1 mm³", s.input_volume),
                       "Check the contours and their units (mm)" + or_skip(roi.name));
  }
  // The grid must be fine enough for the structure but fit into memory; smoothing must be well below its thickness.
  const double radius = std::sqrt(largest / std::numbers::pi);
  if (s.name == "body") {
    const auto grid = interpolate_slices(*meant, std::clamp(radius / 20, 1.0, 4.0), 0);
    s.input_volume *= trim_body(*grid, anatomy);
    s.shape = grid;
  } else {
    const auto grid = interpolate_slices(*meant, std::clamp(radius / 20, 0.5, 3.0), std::min(1.2, 0.08 * radius));
    if (drop_small_islands(*grid, kSmallIsland) > 0) {
      anatomy.notes.push_back(
          fmt::format("Small pieces of '{}' that lie apart from its main part were left out.", roi.name));
    }
    s.shape = grid;
  }
  if (!(s.shape->inner_radius() > 0)) {
    return input_error(where, "the contours enclose nothing at the resolution of the mesher (0.5 mm)",
                       "Check whether they are thinner than that or cancel each other out" + or_skip(roi.name));
  }
  return s;
}

/// Unites a second ROI of the same region with the first.
void join(Structure& first, const Structure& second, std::vector<std::string>& notes) {
  const auto united = unite(static_cast<const GridShape&>(*first.shape), static_cast<const GridShape&>(*second.shape));
  const double overlapping = united->volume(0) / (first.shape->volume(0) + second.shape->volume(0));
  first.input_volume = (first.input_volume + second.input_volume) * overlapping;
  first.whole_volume = first.input_volume;
  first.boundary.insert(first.boundary.end(), second.boundary.begin(), second.boundary.end());
  first.shape = united;
  notes.push_back(fmt::format("More than one ROI is named as {}; their union is meshed.", first.name));
}

/// Puts the zones into one layer, which they share without gaps. A prostate that consists of them is dropped.
void join_zones(Anatomy& anatomy) {
  Anatomy joined = anatomy;
  joined.structures.clear();
  joined.layers.clear();
  double zones = 0;
  std::vector<Structure> members;
  for (const Structure& s : anatomy.structures) {
    if (s.target && s.name != "prostate" && (s.name.ends_with("_zone") || s.name == "anterior_stroma")) {
      zones += s.input_volume;
      members.push_back(s);
    }
  }
  if (members.size() < 2) return;
  const Structure* whole = anatomy.find("prostate");
  const bool drop = whole != nullptr && zones > kWholeGland * whole->input_volume;
  if (drop)
    joined.notes.push_back("The zones make up the prostate, so the mesh has no region 'prostate' besides them.");
  bool placed = false;
  for (const Structure& s : anatomy.structures) {
    const bool zone = std::any_of(members.begin(), members.end(), [&](const Structure& m) { return m.name == s.name; });
    if (!zone) {
      if (!(drop && s.name == "prostate")) joined.add(s);
      continue;
    }
    if (placed) continue;
    placed = true;
    std::shared_ptr<const GridShape> solid = std::static_pointer_cast<const GridShape>(members[0].shape);
    for (std::size_t m = 1; m < members.size(); ++m) {
      solid = unite(*solid, static_cast<const GridShape&>(*members[m].shape));
    }
    // Where zones overlap, the volume counts once.
    double sum = 0;
    for (const Structure& m : members) sum += m.shape->volume(0);
    for (Structure& m : members) m.input_volume *= std::min(1.0, solid->volume(0) / sum);
    joined.add(solid, members);
  }
  anatomy = std::move(joined);
}

}  // namespace

Result<Anatomy> anatomy_of(const ContourSet& set, const MeshOptions& options, const Progress& progress) {
  Anatomy anatomy;
  anatomy.source = set.source.empty() ? "contours" : set.source;
  anatomy.notes = set.notes;
  if (set.rois.empty()) {
    return input_error(anatomy.source, "the contour set has no structures",
                       "Export it with the contours of the structures");
  }
  auto chosen = choose_rois(set, options, anatomy.notes);
  if (!chosen) return chosen.error();
  std::vector<const Roi*> rois;
  for (const RoiChoice& c : *chosen) rois.push_back(c.roi);
  auto frame = common_slice_frame(rois, anatomy.source);
  if (!frame) return frame.error();
  for (std::size_t i = 0; i < chosen->size(); ++i) {
    report(progress, "interpolating contours", static_cast<double>(i) / static_cast<double>(chosen->size()));
    auto s = structure_of((*chosen)[i], *frame, options, anatomy);
    if (!s) return s.error();
    if (i > 0 && (*chosen)[i].region == (*chosen)[i - 1].region) {
      join(anatomy.structures.back(), *s, anatomy.notes);
      const Structure whole = anatomy.structures.back();
      anatomy.structures.pop_back();
      anatomy.layers.pop_back();
      anatomy.add(whole);
    } else {
      anatomy.add(*std::move(s));
    }
  }
  join_zones(anatomy);
  return anatomy;
}

}  // namespace stylet::meshing
