// SPDX-License-Identifier: GPL-3.0-or-later
#include "describe.hpp"
#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace stylet::cli {

namespace {

/// Number of edges that do not belong to exactly two triangles. Points at the same place count as one, because STL
/// repeats them for every triangle.
Index open_edges(const Surface& surface) {
  std::map<std::array<double, 3>, Index> number;
  std::vector<Index> merged;
  merged.reserve(surface.points.size());
  for (const Vec3& p : surface.points) {
    merged.push_back(number.try_emplace({p.x(), p.y(), p.z()}, static_cast<Index>(number.size())).first->second);
  }
  std::map<std::pair<Index, Index>, int> triangles_at;
  for (const auto& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Index a = merged[t[i]];
      const Index b = merged[t[(i + 1) % 3]];
      if (a != b) ++triangles_at[std::minmax(a, b)];
    }
  }
  return static_cast<Index>(
      std::count_if(triangles_at.begin(), triangles_at.end(), [](const auto& edge) { return edge.second != 2; }));
}

/// Volume enclosed by a closed surface [cc] (divergence theorem), positive with outward normals.
double enclosed_cc(const Surface& surface) {
  if (surface.points.empty()) return 0;
  const Vec3 origin = surface.points.front();
  double six_times = 0;
  for (const auto& t : surface.triangles) {
    six_times +=
        (surface.points[t[0]] - origin).dot((surface.points[t[1]] - origin).cross(surface.points[t[2]] - origin));
  }
  return six_times / 6000;
}

}  // namespace

Description describe(const std::vector<Surface>& surfaces) {
  Description out;
  out.json = {{"kind", "surfaces"}, {"surfaces", Json::array()}};
  Table table({"surface", "points", "triangles", "extent mm", "open edges", "volume cc"});
  for (const Surface& surface : surfaces) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : surface.points) box.extend(p);
    const Index open = open_edges(surface);
    const double volume_cc = enclosed_cc(surface);
    out.json["surfaces"].push_back({{"name", surface.name},
                                    {"points", surface.points.size()},
                                    {"triangles", surface.triangles.size()},
                                    {"extent_mm", extent_json(box)},
                                    {"open_edges", open},
                                    {"volume_cc", open == 0 ? Json(volume_cc) : Json(nullptr)}});
    table.row({surface.name, fmt::to_string(surface.points.size()), fmt::to_string(surface.triangles.size()),
               extent_text(box), fmt::to_string(open), open == 0 ? fmt::format("{:.2f}", volume_cc) : ""});
  }
  Facts facts;
  facts.add("kind", fmt::format("{} triangulated surface{}", surfaces.size(), surfaces.size() == 1 ? "" : "s"));
  out.text = facts.text() + "\n\n" + table.text();
  return out;
}

}  // namespace stylet::cli
