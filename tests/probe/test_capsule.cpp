// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/capsule.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stylet {
namespace {

const Capsule kProbe{{1.0, 2.0, 3.0}, Vec3(0.1, -0.2, 1.0).normalized(), 10.0};

Vec3 random_unit(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

TEST(Capsule, gap_is_the_distance_from_the_surface_where_the_wall_faces_the_probe) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = kProbe.centre_mm + 15.0 * random_unit(random);
    const Capsule::Gap nearest = kProbe.nearest(p);
    const Capsule::Gap gap = kProbe.gap(p, nearest.normal);
    EXPECT_NEAR(gap.mm, nearest.mm, 1e-12);
    EXPECT_LT((gap.normal - nearest.normal).norm(), 1e-12);
  }
}

TEST(Capsule, a_point_without_penetration_on_its_own_side_is_outside_of_the_probe) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = kProbe.centre_mm + 12.0 * random_unit(random) - 5.0 * kProbe.axis;
    const Vec3 outward = random_unit(random);
    if (outward.dot(kProbe.axis) < -0.9) continue;
    EXPECT_LE(kProbe.gap(p, outward).mm, kProbe.nearest(p).mm + 1e-9);
  }
}

TEST(Capsule, force_never_leaves_the_side_of_the_wall) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = kProbe.centre_mm + 25.0 * random_unit(random);
    Vec3 outward = random_unit(random);
    if (outward.dot(kProbe.axis) < 0.0) outward = (outward - outward.dot(kProbe.axis) * kProbe.axis).normalized();
    const Vec3 n = kProbe.gap(p, outward).normal;
    EXPECT_NEAR(n.norm(), 1.0, 1e-12);
    EXPECT_GE(n.dot(outward), Capsule::kCosSide - 1e-9);
    EXPECT_GE(n.dot(kProbe.axis), -1e-9) << "the shaft goes on without end, so nothing leaves the probe backwards";
  }
}

TEST(Capsule, gap_is_continuous_also_deep_in_the_probe_and_behind_it) {
  std::mt19937 random(4);
  constexpr double step_mm = 1e-4;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = kProbe.centre_mm + 14.0 * std::uniform_real_distribution<double>()(random) * random_unit(random);
    const Vec3 outward = random_unit(random);
    if (outward.dot(kProbe.axis) < -0.9) continue;
    const double here = kProbe.gap(p, outward).mm;
    const double there = kProbe.gap(p + step_mm * random_unit(random), outward).mm;
    EXPECT_LE(std::abs(there - here), step_mm * (1.0 + 1e-6)) << "a distance changes by at most the way";
  }
}

TEST(Capsule, a_wall_that_bends_back_over_the_tip_is_pushed_to_its_own_side) {
  // The anterior wall crosses in front of the tip, behind the axis: the nearest point of the probe is posterior.
  const Capsule probe{Vec3::Zero(), Vec3::UnitZ(), 10.0};
  const Vec3 p(0.0, 5.0, 6.0);
  const Vec3 anterior = -Vec3::UnitY();
  EXPECT_GT(probe.nearest(p).normal.y(), 0.5);
  EXPECT_LT(probe.gap(p, anterior).normal.y(), -0.5);
  EXPECT_LT(probe.gap(p, anterior).mm, probe.nearest(p).mm);
}

}  // namespace
}  // namespace stylet
