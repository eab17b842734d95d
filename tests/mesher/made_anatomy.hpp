// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/contours.hpp"
#include "stylet/geom/label_image.hpp"

#include <cmath>
#include <numbers>

namespace stylet::testing {

/// A circle in a transverse plane.
inline Contour circle(const Vec3& centre, double radius, int points = 48) {
  Contour c;
  for (int i = 0; i < points; ++i) {
    const double a = 2 * std::numbers::pi * i / points;
    c.points.push_back(centre + radius * Vec3(std::cos(a), std::sin(a), 0));
  }
  return c;
}

/// Slices of an ellipsoid every `gap` mm, half a gap from its poles.
inline Roi ellipsoid(const std::string& name, const Vec3& centre, const Vec3& half, double gap) {
  Roi roi;
  roi.name = name;
  const int slices = static_cast<int>(std::floor(2 * half.z() / gap));
  for (int k = 0; k < slices; ++k) {
    const double z = (k - 0.5 * (slices - 1)) * gap;
    const double r = std::sqrt(std::max(0.0, 1 - z * z / (half.z() * half.z())));
    Contour c;
    for (int i = 0; i < 48; ++i) {
      const double a = 2 * std::numbers::pi * i / 48;
      c.points.push_back(centre + Vec3(half.x() * r * std::cos(a), half.y() * r * std::sin(a), z));
    }
    roi.contours.push_back(std::move(c));
  }
  return roi;
}

/// A straight tube along z.
inline Roi tube(const std::string& name, const Vec3& from, double length, double radius, double gap) {
  Roi roi;
  roi.name = name;
  for (double z = 0; z <= length + 1e-9; z += gap) roi.contours.push_back(circle(from + Vec3(0, 0, z), radius, 24));
  return roi;
}

/// A gland of 40 x 32 x 36 mm.
inline Roi gland(const std::string& name = "Prostate", double gap = 3) {
  return ellipsoid(name, Vec3(5, -20, 10), Vec3(20, 16, 18), gap);
}

inline ContourSet set_of(std::vector<Roi> rois) {
  ContourSet set;
  set.source = "made in the test";
  set.rois = std::move(rois);
  return set;
}

/// Two zones, posterior (1) and anterior (2), of an ellipsoid in the image's own frame.
inline LabelImage two_zones(const Mat3& direction = Mat3::Identity(), const Vec3& origin = Vec3::Zero()) {
  LabelImage image;
  image.source = "made in the test";
  image.size = {64, 56, 14};
  image.spacing = Vec3(0.8, 0.8, 3.5);
  image.direction = direction;
  image.origin = origin;
  image.labels.resize(64 * 56 * 14, 0);
  std::size_t n = 0;
  for (int k = 0; k < 14; ++k) {
    for (int j = 0; j < 56; ++j) {
      for (int i = 0; i < 64; ++i, ++n) {
        const Vec3 p = image.spacing.cwiseProduct(Vec3(i - 31.5, j - 27.5, k - 6.5));
        if (p.cwiseQuotient(Vec3(20, 16, 18)).squaredNorm() > 1) continue;
        image.labels[n] = p.y() + 0.01 * p.x() * p.x() > 5 ? 1 : 2;
      }
    }
  }
  return image;
}

}  // namespace stylet::testing
