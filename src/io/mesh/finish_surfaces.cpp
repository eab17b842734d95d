// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/surfaces.hpp"

#include "detail/reach.hpp"
#include "mesh/vtk_cells.hpp"
#include "stylet/geom/plausible_size.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace stylet::detail {

namespace {

constexpr double weld_mm = 1e-4;

/// Merges points that round to the same multiple of weld_mm.
void weld(Surface& surface) {
  using Key = std::array<std::int64_t, 3>;
  const auto key = [&](Index p) {
    const Vec3& x = surface.points[p];
    return Key{std::llround(x.x() / weld_mm), std::llround(x.y() / weld_mm), std::llround(x.z() / weld_mm)};
  };
  std::map<Key, Index> first;
  std::vector<Index> renumbered(surface.points.size());
  std::vector<Vec3> points;
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    const auto [found, is_new] = first.emplace(key(static_cast<Index>(p)), static_cast<Index>(points.size()));
    if (is_new) points.push_back(surface.points[p]);
    renumbered[p] = found->second;
  }
  surface.points = std::move(points);
  std::erase_if(surface.triangles, [&](std::array<Index, 3>& t) {
    for (Index& p : t) p = renumbered[p];
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  });
}

/// Whether every edge is used once in each direction.
bool is_closed(const Surface& surface) {
  std::vector<std::pair<Index, Index>> edges, reversed;
  for (const auto& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      edges.emplace_back(t[i], t[(i + 1) % 3]);
      reversed.emplace_back(t[(i + 1) % 3], t[i]);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return edges == reversed;
}

double signed_volume(const Surface& surface) {
  double six = 0.0;
  const Vec3& o = surface.points.front();
  for (const auto& t : surface.triangles) {
    six += (surface.points[t[0]] - o).cross(surface.points[t[1]] - o).dot(surface.points[t[2]] - o);
  }
  return six / 6.0;
}

}  // namespace

Result<Surface> to_surface(vtkPolyData& data, std::string name, const std::string& source) {
  Surface surface;
  surface.name = std::move(name);
  surface.points.resize(static_cast<std::size_t>(data.GetNumberOfPoints()));
  for (std::size_t p = 0; p < surface.points.size(); ++p)
    data.GetPoint(static_cast<vtkIdType>(p), surface.points[p].data());
  const Error damaged = input_error(source, "a triangle refers to a point that is not in the file",
                                    "The file is truncated or damaged; copy or export it again");
  if (!cells_are_whole(data.GetPolys()) || !cells_are_whole(data.GetStrips())) return damaged;
  bool is_whole = true;
  const auto add = [&](vtkIdType a, vtkIdType b, vtkIdType c) {
    const vtkIdType count = data.GetNumberOfPoints();
    if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= count) {
      is_whole = false;
      return;
    }
    surface.triangles.push_back({static_cast<Index>(a), static_cast<Index>(b), static_cast<Index>(c)});
  };
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  const auto polygons = vtk::TakeSmartPointer(data.GetPolys()->NewIterator());
  for (polygons->GoToFirstCell(); !polygons->IsDoneWithTraversal(); polygons->GoToNextCell()) {
    polygons->GetCurrentCell(count, ids);
    for (vtkIdType i = 2; i < count; ++i) add(ids[0], ids[i - 1], ids[i]);
  }
  const auto strips = vtk::TakeSmartPointer(data.GetStrips()->NewIterator());
  for (strips->GoToFirstCell(); !strips->IsDoneWithTraversal(); strips->GoToNextCell()) {
    strips->GetCurrentCell(count, ids);
    for (vtkIdType i = 2; i < count; ++i)
      i % 2 == 0 ? add(ids[i - 2], ids[i - 1], ids[i]) : add(ids[i - 1], ids[i - 2], ids[i]);
  }
  if (!is_whole) return damaged;
  return surface;
}

Result<SurfacesWithNotes> finish_surfaces(std::vector<Surface> surfaces, const std::string& source) {
  Eigen::AlignedBox3d box;
  for (const Surface& surface : surfaces) {
    for (std::size_t p = 0; p < surface.points.size(); ++p) {
      if (is_in_reach(surface.points[p])) continue;
      return check_reach(fmt::format("{}, surface '{}'", source, surface.name), surface.points[p],
                         fmt::format("point {}", p))
          .error();
    }
    for (const auto& t : surface.triangles) {
      for (const Index p : t) box.extend(surface.points[p]);
    }
  }
  if (box.isEmpty()) return input_error(source, "there are no triangles", "Export triangulated surfaces");
  constexpr double smallest_mm = 1.0;  // of a part, such as a piece of the urethra
  if (Result<> size = check_size(box.sizes().maxCoeff(), source, "the surface", 1.0, smallest_mm); !size)
    return size.error();
  SurfacesWithNotes out;
  for (Surface& surface : surfaces) {
    weld(surface);
    if (surface.triangles.empty()) {
      out.notes.push_back(fmt::format("Surface '{}' has no area and is ignored.", surface.name));
      continue;
    }
    if (is_closed(surface) && signed_volume(surface) < 0.0) {
      for (auto& t : surface.triangles) std::swap(t[1], t[2]);
    }
    out.surfaces.push_back(std::move(surface));
  }
  if (out.surfaces.empty()) return input_error(source, "its triangles have no area", "Export triangulated surfaces");
  return out;
}

}  // namespace stylet::detail
