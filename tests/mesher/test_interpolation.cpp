// SPDX-License-Identifier: GPL-3.0-or-later
#include "made_anatomy.hpp"
#include "shape.hpp"

#include <gtest/gtest.h>

namespace stylet::meshing {
namespace {

StructureSlices slices_of(const Roi& roi) { return structure_slices(roi, "", SliceFrame{}).value(); }

TEST(SliceInterpolation, a_sphere_from_slices_has_its_volume_and_its_distances) {
  const double radius = 20;
  const Roi roi = testing::ellipsoid("sphere", Vec3::Zero(), Vec3::Constant(radius), 4);
  const auto shape = interpolate_slices(slices_of(roi), 0.9, 0.5);
  EXPECT_NEAR(shape->volume(0) / (4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3)), 1, 0.02);
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(1, 1, 0.5), Vec3(-1, 2, -1)}) {
    const Vec3 u = direction.normalized();
    EXPECT_NEAR(shape->distance(radius * u), 0, 0.5);
    EXPECT_NEAR(shape->distance(0.6 * radius * u), -0.4 * radius, 0.8);
    EXPECT_NEAR(shape->distance(3 * radius * u), 2 * radius, 8.0) << "far off the grid, an estimate";
  }
  EXPECT_NEAR(shape->inner_radius(), radius, 2.0);
}

TEST(SliceInterpolation, the_surface_passes_through_the_contours) {
  const Roi roi = testing::ellipsoid("e", Vec3(3, 2, 1), Vec3(22, 15, 18), 5);
  const auto shape = interpolate_slices(slices_of(roi), 0.8, 0.0);
  for (std::size_t k = 1; k + 1 < roi.contours.size(); ++k) {
    for (const Vec3& p : roi.contours[k].points) EXPECT_NEAR(shape->distance(p), 0, 0.25);
  }
}

TEST(SliceInterpolation, a_structure_ends_half_a_slice_beyond_its_last_contour) {
  const Roi roi = testing::tube("tube", Vec3::Zero(), 20, 10, 4);
  const auto shape = interpolate_slices(slices_of(roi), 0.5, 0.0);
  EXPECT_LT(shape->distance(Vec3(0, 0, 21.7)), 0);
  EXPECT_GT(shape->distance(Vec3(0, 0, 22.3)), 0);
  EXPECT_LT(shape->distance(Vec3(0, 0, -1.7)), 0);
  EXPECT_GT(shape->distance(Vec3(0, 0, -2.3)), 0);
  EXPECT_GT(shape->distance(Vec3(9.5, 0, 21.7)), 0) << "the cap is rounded";
}

TEST(SliceInterpolation, an_inner_contour_is_a_hole) {
  Roi roi = testing::tube("outer", Vec3::Zero(), 20, 12, 4);
  for (const Contour& c : testing::tube("inner", Vec3::Zero(), 20, 5, 4).contours) roi.contours.push_back(c);
  const StructureSlices slices = slices_of(roi);
  ASSERT_EQ(slices.slices.size(), 6U);
  EXPECT_NEAR(slices.slices[2].area_mm2, std::numbers::pi * (144 - 25), 6);
  const auto shape = interpolate_slices(slices, 0.6, 0.0);
  EXPECT_GT(shape->distance(Vec3(0, 0, 10)), 3);
  EXPECT_LT(shape->distance(Vec3(8.5, 0, 10)), -3);
  EXPECT_GT(shape->distance(Vec3(14, 0, 10)), 1);
}

TEST(SliceInterpolation, a_missing_slice_is_bridged_and_a_wide_gap_is_not) {
  Roi roi = testing::tube("tube", Vec3::Zero(), 40, 8, 4);
  roi.contours.erase(roi.contours.begin() + 5);
  EXPECT_LT(interpolate_slices(slices_of(roi), 0.6, 0)->distance(Vec3(0, 0, 20)), -5);
  EXPECT_NEAR(slices_of(roi).slices[4].thickness(), 6, 1e-9);
  for (const Contour& c : testing::tube("far", Vec3(0, 0, 80), 12, 8, 4).contours) roi.contours.push_back(c);
  const auto two = interpolate_slices(slices_of(roi), 0.6, 0);
  EXPECT_GT(two->distance(Vec3(0, 0, 60)), 5);
  EXPECT_LT(two->distance(Vec3(0, 0, 86)), -5);
}

TEST(MaskDistance, is_exact_between_pixel_centres) {
  const int nx = 31, ny = 23;
  const double dx = 0.7, dy = 1.1;
  std::vector<bool> mask(nx * ny, false);
  for (int j = 5; j < 15; ++j) {
    for (int i = 8; i < 20; ++i) mask[j * nx + i] = (i + j) % 11 != 0;
  }
  const std::vector<float> d = mask_distance(mask, nx, ny, dx, dy);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      double nearest = HUGE_VAL;
      for (int y = 0; y < ny; ++y) {
        for (int x = 0; x < nx; ++x) {
          if (mask[y * nx + x] == mask[j * nx + i]) continue;
          nearest = std::min(nearest, std::hypot((x - i) * dx, (y - j) * dy));
        }
      }
      const double expected = nearest - 0.25 * (dx + dy);
      EXPECT_NEAR(d[j * nx + i], mask[j * nx + i] ? -expected : expected, 1e-5);
    }
  }
  EXPECT_TRUE(mask_distance(std::vector<bool>(nx * ny, false), nx, ny, dx, dy).empty());
}

TEST(Redistance, keeps_the_surface_and_makes_distances) {
  GridShape g;
  g.low = Vec3::Constant(-15);
  g.spacing = Vec3(0.8, 1.0, 1.2);
  g.size = {39, 31, 26};
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        const double r = g.node(i, j, k).norm();
        g.values.push_back(
            static_cast<float>(0.01 * (r * r - 81)));  // the zero surface is right, the other values are wrong
      }
    }
  }
  redistance(g);
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        EXPECT_NEAR(g.values[g.at(i, j, k)], g.node(i, j, k).norm() - 9, 0.7);
      }
    }
  }
}

TEST(Superquadric, volume_and_distance_agree_with_counting) {
  const Vec3 half(10, 8, 6);
  const Superquadric body(Vec3(1, 2, 3), half);
  EXPECT_NEAR(body.distance(Vec3(14, 2, 3)), 3, 1e-9);
  EXPECT_NEAR(body.distance(Vec3(1, 5, 3)), -5, 1e-9);
  EXPECT_LT(body.distance(Vec3(1, 2, 3)), 0);
  double inside = 0;
  const double h = 0.25;
  for (double x = -10 + h / 2; x < 10; x += h) {
    for (double y = -8 + h / 2; y < 8; y += h) {
      for (double z = -6 + h / 2; z < 6; z += h) inside += body.distance(Vec3(1 + x, 2 + y, 3 + z)) < 0 ? h * h * h : 0;
    }
  }
  EXPECT_NEAR(body.volume(0) / inside, 1, 0.01);
}

}  // namespace
}  // namespace stylet::meshing
