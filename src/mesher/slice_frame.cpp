// SPDX-License-Identifier: GPL-3.0-or-later
#include "slice_frame.hpp"

#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace stylet::meshing {
namespace {

/// Area vector of a closed polygon (Newell): its direction is the normal of the plane, its length the area [mm²].
Vec3 area_vector(const Contour& contour) {
  Vec3 sum = Vec3::Zero();
  const std::size_t n = contour.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = contour.points[i] - contour.points[0];
    const Vec3 b = contour.points[(i + 1) % n] - contour.points[0];
    sum += 0.5 * a.cross(b);
  }
  return sum;
}

double signed_area(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    sum += 0.5 * (a.x() * b.y() - b.x() * a.y());
  }
  return sum;
}

bool contains(const Polygon& polygon, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const auto& a = polygon[i];
    const auto& b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  return inside;
}

Eigen::Vector2d mean_point(const Polygon& polygon) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& p : polygon) sum += p;
  return sum / static_cast<double>(polygon.size());
}

bool same(const Polygon& a, const Polygon& b) {
  const double area = std::abs(signed_area(a));
  return a.size() == b.size() && std::abs(area - std::abs(signed_area(b))) <= 1e-6 * area &&
         (mean_point(a) - mean_point(b)).norm() < 1e-3;
}

}  // namespace

double Slice::area() const {
  // A polygon at an odd nesting depth is a hole. Any vertex gives the depth, because the polygons do not cross.
  double sum = 0;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    int depth = 0;
    for (std::size_t j = 0; j < polygons.size(); ++j) {
      if (j != i && contains(polygons[j], polygons[i][0])) ++depth;
    }
    sum += (depth % 2 == 0 ? 1.0 : -1.0) * std::abs(signed_area(polygons[i]));
  }
  return sum;
}

Result<SliceFrame> common_frame(const ContourSet& contours, const std::vector<const Roi*>& rois) {
  Vec3 normal = Vec3::Zero();
  for (const Roi* roi : rois) {
    for (const Contour& c : roi->contours) {
      const Vec3 v = area_vector(c);
      normal += v.dot(normal) < 0 ? Vec3(-v) : v;
    }
  }
  if (!(normal.norm() > 0)) {
    return input_error(contours.source, "the contours enclose no area", "Export the structures again");
  }
  normal.normalize();
  Eigen::Index largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  if (normal[largest] < 0) normal = -normal;
  // Contours drawn on axial slices give exactly the patient's axes.
  for (int k = 0; k < 3; ++k) {
    if (normal[k] > 1 - 1e-9) normal = Vec3::Unit(k);
  }
  SliceFrame frame;
  const Vec3 along = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 u = (along - along.dot(normal) * normal).normalized();
  frame.axes.col(0) = u;
  frame.axes.col(1) = normal.cross(u);
  frame.axes.col(2) = normal;
  for (const Roi* roi : rois) {
    for (const Contour& c : roi->contours) {
      double low = HUGE_VAL;
      double high = -HUGE_VAL;
      for (const Vec3& p : c.points) {
        low = std::min(low, p.dot(normal));
        high = std::max(high, p.dot(normal));
      }
      if (high - low > 0.5) {
        return input_error(
            fmt::format("{}, ROI '{}', contour near ({:.1f}, {:.1f}, {:.1f}) mm", contours.source, roi->name,
                        c.points[0].x(), c.points[0].y(), c.points[0].z()),
            fmt::format("the contour leaves the common slice plane by {:.2f} mm, expected at most 0.5 mm "
                        "(parallel planar contours)",
                        high - low),
            "Draw all structures on the same parallel slices" + or_skip(roi->name));
      }
    }
  }
  return frame;
}

std::vector<Slice> to_slices(const std::vector<Contour>& contours, const SliceFrame& frame) {
  std::vector<std::pair<double, Polygon>> flat;
  for (const Contour& c : contours) {
    Polygon polygon;
    double height = 0;
    for (const Vec3& p : c.points) {
      const Vec3 q = frame.local(p);
      polygon.emplace_back(q.x(), q.y());
      height += q.z() / static_cast<double>(c.points.size());
    }
    if (polygon.size() >= 3) flat.emplace_back(height, std::move(polygon));
  }
  std::stable_sort(flat.begin(), flat.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Slice> slices;
  for (auto& [height, polygon] : flat) {
    // Heights within 0.1 mm belong to one slice, written with rounding.
    if (slices.empty() || height - slices.back().height > 0.1) slices.push_back({height, {}});
    // Under the even-odd rule, a contour that occurs twice would cancel itself out.
    auto& there = slices.back().polygons;
    if (std::none_of(there.begin(), there.end(), [&](const Polygon& p) { return same(p, polygon); })) {
      there.push_back(std::move(polygon));
    }
  }
  return slices;
}

double slice_gap(const std::vector<Slice>& slices) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < slices.size(); ++i) gaps.push_back(slices[i].height - slices[i - 1].height);
  if (gaps.empty()) return 0;
  std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2), gaps.end());
  return gaps[gaps.size() / 2];
}

std::vector<double> slice_thickness(const std::vector<Slice>& slices) {
  const double gap = slice_gap(slices);
  std::vector<double> thickness(slices.size(), gap);
  for (std::size_t i = 0; i < slices.size(); ++i) {
    double below = i > 0 ? slices[i].height - slices[i - 1].height : gap;
    double above = i + 1 < slices.size() ? slices[i + 1].height - slices[i].height : gap;
    if (below > kMaxBridgedGaps * gap) below = gap;
    if (above > kMaxBridgedGaps * gap) above = gap;
    thickness[i] = 0.5 * (below + above);
  }
  return thickness;
}

}  // namespace stylet::meshing
