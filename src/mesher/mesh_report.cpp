// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_report.hpp"

#include "surface_distance.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace stylet::meshing {
namespace {

constexpr double kVolumeTolerance = 0.03;

/// Points of the structure's boundary that are also on the boundary of its region, not inside a structure of higher
/// priority.
std::vector<Vec3> visible_boundary(const Anatomy& a, const Structure& s) {
  std::vector<Vec3> points;
  for (const Vec3& p : s.boundary) {
    bool covered = false;
    for (const Layer& layer : a.layers) {
      const auto& m = layer.members;
      if (std::any_of(m.begin(), m.end(), [&](int i) { return &a.structures[i] == &s; })) break;
      if (layer.box.contains(p) && layer.solid->distance(p) < layer.offset) {
        covered = true;
        break;
      }
    }
    if (!covered) points.push_back(p);
  }
  return points;
}

}  // namespace

MeshReport report_on(const TetMesh& mesh, const Anatomy& a) {
  MeshReport r;
  r.notes = a.notes;
  r.contour_points = a.contour_points;
  r.contour_points_kept = a.contour_points_kept;
  r.quality = mesh_quality(mesh);
  DistanceSummary total;
  for (std::size_t k = 0; k < mesh.regions.size(); ++k) {
    const Structure& s = *a.find(mesh.regions[k]);
    RegionReport region;
    region.name = s.name;
    region.tets = r.quality.region_tets[k];
    region.volume_cc = r.quality.region_volume_cc[k];
    region.input_volume_cc = s.input_volume / 1000;
    region.structure_volume_cc = s.whole_volume / 1000;
    const DistanceSummary d = distance_to_boundary(mesh, static_cast<int>(k), visible_boundary(a, s));
    if (d.count > 0) {
      region.surface_mean_mm = d.sum / static_cast<double>(d.count);
      region.surface_max_mm = d.max;
      total.sum += d.sum;
      total.count += d.count;
      total.max = std::max(total.max, d.max);
    }
    const double error = s.input_volume > 0 ? region.volume_cc / region.input_volume_cc - 1 : 0;
    if (std::abs(error) > kVolumeTolerance) {
      r.notes.push_back(fmt::format(
          "The volume of the region '{}' differs by {:+.0f} % from its input: the mesh has too few nodes for it.",
          s.name, 100 * error));
    }
    r.regions.push_back(std::move(region));
  }
  if (total.count > 0) r.surface_mean_mm = total.sum / static_cast<double>(total.count);
  r.surface_max_mm = total.max;
  return r;
}

}  // namespace stylet::meshing
