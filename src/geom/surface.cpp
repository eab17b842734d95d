// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/surface.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {
constexpr float kFarthest_mm = 1e6F;
}  // namespace

FlatSurfaces flatten(std::span<const Surface> surfaces) {
  FlatSurfaces flat;
  for (const Surface& surface : surfaces) {
    for (const Vec3& x : surface.points) {
      for (const double value : x) flat.points_mm.push_back(static_cast<float>(value));
    }
    for (const auto& triangle : surface.triangles)
      flat.triangles.insert(flat.triangles.end(), triangle.begin(), triangle.end());
    flat.sizes.push_back(static_cast<Index>(surface.points.size()));
    flat.sizes.push_back(static_cast<Index>(surface.triangles.size()));
  }
  return flat;
}

std::optional<std::vector<Surface>> unflatten(const FlatSurfaces& flat, std::span<const std::string> names) {
  if (flat.sizes.size() != 2 * names.size()) return std::nullopt;
  const auto possible = [](float x) { return std::abs(x) <= kFarthest_mm; };
  if (!std::all_of(flat.points_mm.begin(), flat.points_mm.end(), possible)) return std::nullopt;
  std::vector<Surface> surfaces;
  std::span<const float> points = flat.points_mm;
  std::span<const Index> corners = flat.triangles;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Index count = flat.sizes[2 * k], triangles = flat.sizes[2 * k + 1];
    if (count < 0 || triangles < 0 || points.size() / 3 < static_cast<std::size_t>(count) ||
        corners.size() / 3 < static_cast<std::size_t>(triangles)) {
      return std::nullopt;
    }
    Surface surface{.name = names[k], .points = {}, .triangles = {}};
    for (Index n = 0; n < count; ++n, points = points.subspan(3))
      surface.points.emplace_back(points[0], points[1], points[2]);
    for (Index t = 0; t < triangles; ++t, corners = corners.subspan(3)) {
      if (std::any_of(corners.begin(), corners.begin() + 3, [&](Index n) { return n < 0 || n >= count; }))
        return std::nullopt;
      surface.triangles.push_back({corners[0], corners[1], corners[2]});
    }
    surfaces.push_back(std::move(surface));
  }
  if (!points.empty() || !corners.empty()) return std::nullopt;
  return surfaces;
}

}  // namespace stylet
