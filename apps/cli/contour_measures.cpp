// SPDX-License-Identifier: GPL-3.0-or-later
#include "contour_measures.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace stylet::cli {

namespace {

constexpr double kSamePlane = 0.01;  ///< [mm] contours closer than this lie on one slice

/// Area times unit normal of a closed polygon [mm²] (Newell).
Vec3 area_vector(const Contour& contour) {
  Vec3 sum = Vec3::Zero();
  const std::size_t n = contour.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    sum += (contour.points[i] - contour.points[0]).cross(contour.points[(i + 1) % n] - contour.points[0]);
  }
  return 0.5 * sum;
}

/// Whether p lies in the polygon when both are projected along the normal. Uses the parity of crossings of a ray.
bool inside(const Vec3& p, const Contour& contour, const Vec3& normal) {
  const Vec3 u = normal.unitOrthogonal();
  const Vec3 v = normal.cross(u);
  bool in = false;
  const std::size_t n = contour.points.size();
  for (std::size_t i = 0, j = n - 1; i < n; j = i++) {
    const double vi = v.dot(contour.points[i] - p);
    const double vj = v.dot(contour.points[j] - p);
    if ((vi > 0) == (vj > 0)) continue;
    const double ui = u.dot(contour.points[i] - p);
    const double uj = u.dot(contour.points[j] - p);
    if (ui + (uj - ui) * vi / (vi - vj) > 0) in = !in;
  }
  return in;
}

struct Slice {
  double height = 0;  ///< [mm] along the normal
  std::vector<const Contour*> contours;
};

/// Area of a slice [mm²]: a contour inside an odd number of others is a hole.
double area(const Slice& slice, const Vec3& normal) {
  double sum = 0;
  for (const Contour* contour : slice.contours) {
    const auto around = std::count_if(slice.contours.begin(), slice.contours.end(), [&](const Contour* other) {
      return other != contour && inside(contour->points.front(), *other, normal);
    });
    sum += (around % 2 == 0 ? 1 : -1) * area_vector(*contour).norm();
  }
  return sum;
}

std::vector<Slice> slices_of(const Roi& roi, const Vec3& normal) {
  std::vector<std::pair<double, const Contour*>> by_height;
  for (const Contour& contour : roi.contours) {
    if (!contour.points.empty()) by_height.emplace_back(normal.dot(contour.points.front()), &contour);
  }
  std::sort(by_height.begin(), by_height.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Slice> slices;
  for (const auto& [height, contour] : by_height) {
    if (slices.empty() || height - slices.back().height > kSamePlane) slices.push_back({height, {}});
    slices.back().contours.push_back(contour);
  }
  return slices;
}

}  // namespace

RoiMeasures measure(const Roi& roi) {
  RoiMeasures out;
  Vec3 largest = Vec3::Zero();
  for (const Contour& contour : roi.contours) {
    out.points += static_cast<Index>(contour.points.size());
    for (const Vec3& p : contour.points) out.box.extend(p);
    const Vec3 candidate = area_vector(contour);
    if (candidate.squaredNorm() > largest.squaredNorm()) largest = candidate;
  }
  if (largest.squaredNorm() == 0) return out;
  const Vec3 normal = largest.normalized();
  const std::vector<Slice> slices = slices_of(roi, normal);
  out.slices = static_cast<Index>(slices.size());
  if (slices.size() < 2) return out;

  std::vector<double> gaps;
  for (std::size_t i = 1; i < slices.size(); ++i) gaps.push_back(slices[i].height - slices[i - 1].height);
  std::vector<double> sorted = gaps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  out.slice_spacing_mm = sorted[sorted.size() / 2];

  // A slice represents half of the gap on either side. The first and the last represent half a median gap outwards.
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const double below = i > 0 ? gaps[i - 1] : out.slice_spacing_mm;
    const double above = i < gaps.size() ? gaps[i] : out.slice_spacing_mm;
    out.volume_cc += area(slices[i], normal) * 0.5 * (below + above) / 1000;
  }
  return out;
}

}  // namespace stylet::cli
