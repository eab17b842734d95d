// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/contours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

/// Plane geometry of contours on transverse slices. It is deliberately simple, because it is used to check the phantom.
namespace stylet::test {

inline double height(const Contour& c) { return c.points.front().z(); }

inline double area_mm2(const Contour& c) {
  double twice = 0.0;
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const Vec3& a = c.points[i];
    const Vec3& b = c.points[(i + 1) % c.points.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

inline double volume_cc(const Roi& roi, double spacing) {
  double sum = 0.0;
  for (const Contour& c : roi.contours) sum += std::abs(area_mm2(c));
  return sum * spacing / 1000.0;
}

inline bool inside(const Contour& c, const Vec3& p) {
  bool in = false;
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const Vec3& a = c.points[i];
    const Vec3& b = c.points[(i + 1) % c.points.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()))
      in = !in;
  }
  return in;
}

inline double distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

/// Distance between two outlines [mm].
inline double gap(const Contour& c, const Contour& d) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : {std::pair(&c, &d), std::pair(&d, &c)}) {
    for (const Vec3& p : from->points) {
      for (std::size_t i = 0; i < to->points.size(); ++i) {
        best = std::min(best, distance(p, to->points[i], to->points[(i + 1) % to->points.size()]));
      }
    }
  }
  return best;
}

inline bool overlap(const Contour& c, const Contour& d) {
  return std::any_of(c.points.begin(), c.points.end(), [&](const Vec3& p) { return inside(d, p); }) ||
         std::any_of(d.points.begin(), d.points.end(), [&](const Vec3& p) { return inside(c, p); });
}

/// Smallest distance between two structures over all common slices [mm]; -1 when they overlap, infinity when they have
/// no common slice.
inline double clearance(const Roi& a, const Roi& b) {
  double best = std::numeric_limits<double>::infinity();
  for (const Contour& c : a.contours) {
    for (const Contour& d : b.contours) {
      if (std::abs(height(c) - height(d)) > 1e-6) continue;
      if (overlap(c, d)) return -1.0;
      best = std::min(best, gap(c, d));
    }
  }
  return best;
}

inline Eigen::AlignedBox3d box(const Roi& roi) {
  Eigen::AlignedBox3d out;
  for (const Contour& c : roi.contours) {
    for (const Vec3& p : c.points) out.extend(p);
  }
  return out;
}

}  // namespace stylet::test
