// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/region_distance.hpp"

#include "stylet/geom/box_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stylet {
namespace {

constexpr double kExact_mm = 1e-9;
constexpr double kLength_mm = 1e-6;  // a chord ends where the path is within a nanometre of a face
const std::array<int, 1> kInner{1};

/// A cube of 60 mm with cells of 4 mm; the second region is where `inside` is true.
TetMesh body_with(const std::function<bool(const Vec3&)>& inside) {
  TetMesh mesh = box_mesh({-30, -30, -30}, {30, 30, 30}, {15, 15, 15});
  assign_regions(mesh, {"body", "inner"}, [&](const Vec3& x) { return inside(x) ? 1 : 0; });
  return mesh;
}

/// The same mesh with a second region of whole cells, which has the edges of a box.
TetMesh body_with_block() {
  return body_with([](const Vec3& x) { return std::abs(x.x()) < 6 && std::abs(x.y()) < 6 && std::abs(x.z()) < 6; });
}

/// Distance between a point and a segment.
double to_segment(const Vec3& x, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double f = std::clamp((x - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (x - from - f * way).norm();
}

/// Smallest distance between a path and points distributed over all tetrahedra of the inner region. It is not below the
/// true distance, and exceeds it by less than the spacing of the points.
double to_samples(const TetMesh& mesh, const Vec3& from, const Vec3& to, int steps) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.tet_region[t] != 1) continue;
    std::array<Vec3, 4> x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = mesh.nodes[static_cast<std::size_t>(mesh.tets[t][i])];
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        for (int k = 0; i + j + k <= steps; ++k) {
          const Vec3 point = (i * x[0] + j * x[1] + k * x[2] + (steps - i - j - k) * x[3]) / steps;
          least = std::min(least, to_segment(point, from, to));
        }
      }
    }
  }
  return least;
}

TEST(RegionDistance, of_a_way_beside_a_sphere_is_that_to_its_centre_less_its_radius_but_for_the_mesh) {
  constexpr double radius = 12.0;
  // Fine enough for whole tetrahedra to stay close to the sphere.
  TetMesh mesh = box_mesh({-16, -16, -16}, {16, 16, 16}, {24, 24, 24});
  assign_regions(mesh, {"body", "inner"}, [&](const Vec3& x) { return x.norm() < radius ? 1 : 0; });
  const double cell = 32.0 / 24.0;
  for (const auto& [from, to] : {std::pair{Vec3(20, 3, -40), Vec3(20, 3, 40)},    // passes by
                                 std::pair{Vec3(-15, -20, 3), Vec3(25, -14, 9)},  // oblique
                                 std::pair{Vec3(2, 3, -40), Vec3(2, 3, -25)}}) {  // ends before it
    const auto distance = distance_to_regions(mesh, kInner, from, to);
    ASSERT_TRUE(distance);
    EXPECT_NEAR(*distance, to_segment(Vec3::Zero(), from, to) - radius, cell);
  }
}

TEST(RegionDistance, of_a_way_beside_a_cylinder_is_that_of_the_axes_less_its_radius_but_for_the_mesh) {
  constexpr double radius = 8.0;
  const TetMesh mesh = body_with([](const Vec3& x) { return std::hypot(x.x(), x.y()) < radius; });
  // The cylinder's axis is z and the path runs along y at x = 20: the axes are 20 mm apart.
  const auto crossing = distance_to_regions(mesh, kInner, {20, -25, 4}, {20, 25, 7});
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(*crossing, 20.0 - radius, 4.0);
  EXPECT_NEAR(*crossing, to_samples(mesh, {20, -25, 4}, {20, 25, 7}, 4), 0.2);
  // A path parallel to the axis.
  const auto parallel = distance_to_regions(mesh, kInner, {-16, 0, -20}, {-16, 0, 20});
  EXPECT_NEAR(*parallel, 16.0 - radius, 4.0);
}

TEST(RegionDistance, to_a_block_is_exact_beside_faces_edges_and_corners) {
  const TetMesh mesh = body_with_block();  // from −6 to 6 mm
  const auto distance = [&](const Vec3& from, const Vec3& to) {
    return distance_to_regions(mesh, kInner, from, to).value_or(-1.0);
  };
  EXPECT_NEAR(distance({15, 1, -20}, {15, 1, 20}), 9.0, kExact_mm) << "along a face";
  EXPECT_NEAR(distance({9, 10, -20}, {9, 10, 20}), 5.0, kExact_mm) << "along an edge: 3, 4, 5";
  EXPECT_NEAR(distance({1, 2, 20}, {1, 2, 9}), 3.0, kExact_mm) << "its end over the middle of a face";
  EXPECT_NEAR(distance({8, 9, 12}, {18, 19, 32}), 7.0, kExact_mm) << "its end before a corner: 2, 3, 6";
  EXPECT_NEAR(distance({20, 0, 0}, {0, 20, 0}), 8.0 / std::sqrt(2.0), kExact_mm) << "its middle before an edge";
}

TEST(RegionDistance, is_what_points_all_over_the_region_say) {
  const TetMesh mesh = body_with([](const Vec3& x) { return (x - Vec3(3, -2, 5)).norm() < 13; });
  unsigned seed = 5;
  const auto random = [&] {
    seed = seed * 1664525U + 1013904223U;
    return -40.0 + 80.0 * static_cast<double>(seed >> 8U) / static_cast<double>(1U << 24U);
  };
  for (int k = 0; k < 12; ++k) {
    const Vec3 from(random(), random(), random());
    const Vec3 to(random(), random(), random());
    const double sampled = to_samples(mesh, from, to, 6);
    const auto distance = distance_to_regions(mesh, kInner, from, to);
    ASSERT_TRUE(distance);
    EXPECT_LE(*distance, sampled + kExact_mm);
    EXPECT_GE(*distance, sampled - 1.0) << "points are at most 7 / 6 mm apart";
  }
}

TEST(RegionDistance, is_zero_for_a_way_through_the_region_and_none_where_the_region_is_missing) {
  const TetMesh mesh = body_with_block();
  EXPECT_EQ(distance_to_regions(mesh, kInner, {1, 2, -20}, {1, 2, 20}), 0.0) << "through it";
  EXPECT_EQ(distance_to_regions(mesh, kInner, {1, 2, -20}, {1, 2, 0.5}), 0.0) << "ends in it";
  EXPECT_EQ(distance_to_regions(mesh, kInner, {1, 2, -1}, {1.5, 2, 1}), 0.0) << "wholly in it";
  EXPECT_FALSE(distance_to_regions(mesh, {}, {1, 2, -20}, {1, 2, 20})) << "no such structure";
  const std::array<int, 1> other{7};
  EXPECT_FALSE(distance_to_regions(mesh, other, {1, 2, -20}, {1, 2, 20}));
}

TEST(RegionDistance, length_in_a_block_is_that_of_the_chord) {
  const TetMesh mesh = body_with_block();
  const auto length = [&](const Vec3& from, const Vec3& to) { return length_in_regions(mesh, kInner, from, to); };
  EXPECT_NEAR(length({1, 2, -20}, {1, 2, 20}), 12.0, kLength_mm) << "in faces";
  EXPECT_NEAR(length({1, 2, -20}, {1, 2, 1}), 7.0, kLength_mm) << "ends inside";
  EXPECT_NEAR(length({1.5, 2.25, -20}, {1.5, 2.25, 20}), 12.0, kLength_mm) << "in no face";
  EXPECT_NEAR(length({2, 2, -20}, {2, 2, 20}), 12.0, kLength_mm) << "along edges";
  EXPECT_NEAR(length({-20, -20.5, 1}, {20, 19.5, 1}), 11.5 * std::sqrt(2.0), kLength_mm) << "oblique";
  EXPECT_EQ(length({15, 1, -20}, {15, 1, 20}), 0.0) << "beside it";
  EXPECT_EQ(length_in_regions(mesh, {}, {1, 2, -20}, {1, 2, 20}), 0.0);
}

}  // namespace
}  // namespace stylet
