// SPDX-License-Identifier: GPL-3.0-or-later
#include "made_anatomy.hpp"
#include "stylet/mesher/mesher.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

double distance_to_polygon(const Vec3& p, const Contour& c) {
  double best = HUGE_VAL;
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const Vec3& a = c.points[i];
    const Vec3 ab = c.points[(i + 1) % c.points.size()] - a;
    const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (p - a - t * ab).norm());
  }
  return best;
}

TEST(Cull, every_point_read_lies_within_the_tolerance_of_what_is_left) {
  Contour c;
  for (int i = 0; i < 400; ++i) {
    const double a = 2 * std::numbers::pi * i / 400;
    const double r = 20 + 3 * std::sin(5 * a) + 0.1 * std::sin(71 * a);
    c.points.emplace_back(r * std::cos(a), r * std::sin(a), 7);
  }
  for (const double tolerance : {0.05, 0.3, 1.0}) {
    const Contour culled = cull(c, tolerance);
    EXPECT_LT(culled.points.size(), c.points.size());
    for (const Vec3& p : c.points) EXPECT_LE(distance_to_polygon(p, culled), tolerance + 1e-12);
  }
  EXPECT_LT(cull(c, 1.0).points.size(), cull(c, 0.05).points.size());
}

TEST(Cull, points_on_straight_sides_are_superfluous_and_corners_are_not) {
  Contour square;
  for (int side = 0; side < 4; ++side) {
    const Vec3 from(side == 1 || side == 2 ? 10 : 0, side >= 2 ? 10 : 0, 0);
    const Vec3 along(side == 0 ? 1 : side == 2 ? -1 : 0, side == 1 ? 1 : side == 3 ? -1 : 0, 0);
    for (int i = 0; i < 10; ++i) square.points.push_back(from + i * along);
  }
  EXPECT_EQ(cull(square, 0.1).points.size(), 4U);
}

TEST(Cull, what_is_left_is_in_the_order_read_and_culling_again_changes_nothing) {
  const Contour c = testing::circle(Vec3(3, 4, 5), 10, 200);
  const Contour once = cull(c, 0.2);
  const Contour twice = cull(once, 0.2);
  ASSERT_EQ(once.points.size(), twice.points.size());
  std::size_t at = 0;
  for (const Vec3& p : once.points) {
    while (at < c.points.size() && c.points[at] != p) ++at;
    ASSERT_LT(at, c.points.size());
  }
}

TEST(Cull, a_polygon_thinner_than_the_tolerance_stays_a_polygon) {
  Contour sliver;
  sliver.points = {Vec3(0, 0, 0), Vec3(5, 0.01, 0), Vec3(10, 0, 0), Vec3(5, -0.01, 0)};
  EXPECT_GE(cull(sliver, 0.3).points.size(), 3U);
  EXPECT_EQ(cull(sliver, 0.0).points.size(), 4U);
}

}  // namespace
}  // namespace stylet
