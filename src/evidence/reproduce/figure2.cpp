// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/reproduce/figure2.hpp"

#include "needle/tet_segment.hpp"
#include "stylet/geom/topology.hpp"
#include "stylet/mesher/mesher.hpp"

#include <algorithm>
#include <map>

namespace stylet::reproduce {

namespace {

/// Marks the points of a contour that remain after culling. Culling keeps the order of points.
CulledContour marked(const Contour& contour, double cull_mm) {
  const Contour left = cull(contour, cull_mm);
  CulledContour result{contour.points, std::vector<bool>(contour.points.size(), false)};
  std::size_t next = 0;
  for (std::size_t i = 0; i < contour.points.size() && next < left.points.size(); ++i) {
    if (contour.points[i] != left.points[next]) continue;
    result.kept[i] = true;
    ++next;
  }
  return result;
}

/// Adds the faces between the organ's regions and the rest, with outward normals.
void add_surface(Figure2& figure, const TetMesh& mesh) {
  std::vector<bool> organ;
  for (const std::string& region : mesh.regions) organ.push_back(is_target_region(region));
  const auto inside = [&](Index tet) {
    return tet >= 0 && organ[static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(tet)])];
  };
  const Topology topology(mesh);
  std::map<Index, Index> number;  // node of the mesh → point of the surface
  for (const auto* faces : {&topology.interfaces, &topology.boundary}) {
    for (const Face& face : *faces) {
      if (inside(face.tet) == inside(face.neighbour)) continue;
      auto corners = face.nodes;
      if (!inside(face.tet)) std::swap(corners[1], corners[2]);
      for (Index& corner : corners) {
        const auto [place, is_new] = number.try_emplace(corner, static_cast<Index>(number.size()));
        if (is_new) figure.surface_points.push_back(mesh.nodes[static_cast<std::size_t>(corner)]);
        corner = place->second;
      }
      figure.surface_triangles.push_back(corners);
    }
  }
}

/// Makes a segment for the drawing, twice as long as wide.
Figure2::Segment segment(TetNeedle::Segment kind) {
  const double width = NeedleSection{}.outer_diameter_mm;
  const tet::SegmentMesh mesh = tet::make_segment(kind, width, 2.0 * width);
  Figure2::Segment segment;
  segment.points = mesh.nodes;
  for (const tet::Element& element : mesh.elements)
    segment.tets.push_back({element.node[0], element.node[1], element.node[2], element.node[3]});
  return segment;
}

}  // namespace

std::size_t Figure2::points() const {
  std::size_t count = 0;
  for (const CulledContour& contour : contours) count += contour.points.size();
  return count;
}

std::size_t Figure2::points_kept() const {
  std::size_t count = 0;
  for (const CulledContour& contour : contours)
    count += static_cast<std::size_t>(std::count(contour.kept.begin(), contour.kept.end(), true));
  return count;
}

Figure2 make_figure2(const ContourSet& contours, const TetMesh& mesh, double cull_mm) {
  Figure2 figure;
  figure.cull_mm = cull_mm;
  for (const Roi& roi : contours.rois) {
    const std::string region = canonical_region(roi.name);
    if (!is_target_region(region)) continue;
    figure.organ = region;
    for (const Contour& contour : roi.contours) figure.contours.push_back(marked(contour, cull_mm));
    break;
  }
  std::sort(figure.contours.begin(), figure.contours.end(),
            [](const CulledContour& a, const CulledContour& b) { return a.points.front().z() < b.points.front().z(); });
  add_surface(figure, mesh);
  figure.symmetric = segment(TetNeedle::Segment::symmetric);
  figure.asymmetric = segment(TetNeedle::Segment::asymmetric);
  return figure;
}

}  // namespace stylet::reproduce
