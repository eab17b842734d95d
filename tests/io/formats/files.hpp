// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/contours.hpp"

#include "support/folder.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stylet::test {

namespace fs = std::filesystem;

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("'" + from + "' is not in the text");
  return text.replace(at, from.size(), to);
}

template <class T>
std::string why(const Result<T>& result) {
  return result.ok() ? "" : result.error().message();
}

/// Expects an input error whose message has all the given words.
template <class T>
void expect_refused(const Result<T>& result, std::initializer_list<const char*> words) {
  ASSERT_FALSE(result.ok()) << "was accepted, but should be refused for: " << (words.size() > 0 ? *words.begin() : "");
  EXPECT_EQ(result.error().kind, ErrorKind::input);
  EXPECT_FALSE(result.error().where.empty());
  EXPECT_FALSE(result.error().cure.empty());
  for (const char* word : words)
    EXPECT_NE(why(result).find(word), std::string::npos) << why(result) << "\n  lacks: " << word;
}

inline Contour circle(double z, double radius, int points = 24, const Vec3& centre = Vec3::Zero()) {
  Contour c;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * M_PI * i / points;
    c.points.emplace_back(centre + Vec3(radius * std::cos(angle), radius * std::sin(angle), z));
  }
  return c;
}

/// Contours of two balls, "Prostate" and "Rectum".
inline ContourSet two_organs() {
  ContourSet set;
  set.label = "two organs";
  set.frame_of_reference = "1.2.3.4.5";
  for (int n = 0; n < 2; ++n) {
    Roi roi;
    roi.name = n == 0 ? "Prostate" : "Rectum";
    roi.number = n + 1;
    roi.type = "ORGAN";
    roi.colour = {10 * n, 20, 30};
    for (int k = -3; k <= 3; ++k) {
      roi.contours.push_back(circle(5.0 * k, std::sqrt(400.0 - 25.0 * k * k), 24, Vec3(0.1234, 45.6789 * n, 0)));
    }
    set.rois.push_back(roi);
  }
  return set;
}

/// Largest distance between corresponding points; infinite if the sets differ in structure.
inline double largest_difference(const ContourSet& a, const ContourSet& b) {
  double worst = 0.0;
  if (a.rois.size() != b.rois.size()) return INFINITY;
  for (std::size_t r = 0; r < a.rois.size(); ++r) {
    if (a.rois[r].name != b.rois[r].name || a.rois[r].contours.size() != b.rois[r].contours.size()) return INFINITY;
    for (std::size_t c = 0; c < a.rois[r].contours.size(); ++c) {
      const auto &p = a.rois[r].contours[c].points, &q = b.rois[r].contours[c].points;
      if (p.size() != q.size()) return INFINITY;
      for (std::size_t i = 0; i < p.size(); ++i) worst = std::max(worst, (p[i] - q[i]).norm());
    }
  }
  return worst;
}

}  // namespace stylet::test
