// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/mesher/mesher.hpp"

#include <utility>

namespace stylet {
namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

}  // namespace

// Douglas & Peucker 1973, starting from the two points of the closed curve that are farthest apart (found by two
// sweeps). An explicit stack allows contours of any length.
Contour cull(const Contour& contour, double tolerance_mm) {
  const std::vector<Vec3>& p = contour.points;
  const std::size_t n = p.size();
  if (n <= 3 || !(tolerance_mm > 0)) return contour;
  const auto farthest_from = [&](std::size_t from) {
    std::size_t best = from;
    for (std::size_t i = 0; i < n; ++i) {
      if ((p[i] - p[from]).squaredNorm() > (p[best] - p[from]).squaredNorm()) best = i;
    }
    return best;
  };
  const std::size_t a = farthest_from(0);
  const std::size_t b = farthest_from(a);
  if (a == b) return contour;
  std::vector<bool> keep(n, false);
  keep[a] = keep[b] = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{std::min(a, b), std::max(a, b)},
                                                        {std::max(a, b), std::min(a, b) + n}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double worst = tolerance_mm;
    std::size_t split = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double d = distance_to_segment(p[i % n], p[first % n], p[last % n]);
      if (d > worst) {
        worst = d;
        split = i;
      }
    }
    if (split == 0) continue;
    keep[split % n] = true;
    open.emplace_back(first, split);
    open.emplace_back(split, last);
  }
  Contour culled;
  for (std::size_t i = 0; i < n; ++i) {
    if (keep[i]) culled.points.push_back(p[i]);
  }
  // A sliver thinner than the tolerance must remain a polygon.
  return culled.points.size() >= 3 ? culled : contour;
}

}  // namespace stylet
