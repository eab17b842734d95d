// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/slice.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <random>
#include <set>

namespace stylet {
namespace {

/// Positions of the corners of a slice of the undeformed mesh.
Eigen::Matrix3Xf corners(const Slicer& slicer) {
  const Eigen::Matrix3Xf still = Eigen::Matrix3Xf::Zero(3, static_cast<Eigen::Index>(slicer.nodes().size()));
  Eigen::Matrix3Xf at(3, static_cast<Eigen::Index>(slicer.vertices().size()));
  slicer.positions(still, at);
  return at;
}

Vec3 area_vector(const SliceTriangle& triangle, const Eigen::Matrix3Xf& at) {
  const Vec3 a = at.col(triangle.vertices[0]).cast<double>();
  return 0.5 * (at.col(triangle.vertices[1]).cast<double>() - a).cross(at.col(triangle.vertices[2]).cast<double>() - a);
}

/// Area of the slice; triangles that face backwards count negative.
double area(const Slicer& slicer, const Vec3& normal, int region = -1) {
  const Eigen::Matrix3Xf at = corners(slicer);
  double sum = 0.0;
  for (const SliceTriangle& triangle : slicer.triangles()) {
    if (region < 0 || triangle.region == region) sum += area_vector(triangle, at).dot(normal.normalized());
  }
  return sum;
}

/// Area of the section of the unit cube [0,1]³ by n·x = d: −∂/∂d of the volume behind it, by inclusion and exclusion.
double section_of_unit_cube(Vec3 n, double d) {
  for (int i = 0; i < 3; ++i) {  // mirror the cube so that n ≥ 0
    if (n[i] < 0.0) {
      d -= n[i];
      n[i] = -n[i];
    }
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double at = d;
    int ones = 0;
    for (int i = 0; i < 3; ++i) {
      if ((corner >> i & 1) == 0) continue;
      at -= n[i];
      ++ones;
    }
    if (at > 0.0) sum += (ones % 2 == 0 ? 0.5 : -0.5) * at * at;
  }
  return sum * n.norm() / (n[0] * n[1] * n[2]);
}

/// A ball, made from a cube whose shells are mapped to spheres.
TetMesh ball(double radius, int cells) {
  TetMesh mesh = box_mesh(Vec3::Constant(-radius), Vec3::Constant(radius), {cells, cells, cells});
  for (Vec3& x : mesh.nodes) {
    if (x.norm() > 0.0) x *= x.cwiseAbs().maxCoeff() / x.norm();
  }
  return mesh;
}

/// Every triangle lies in the plane and faces along the normal; every edge belongs to two triangles or is on the
/// outside.
void expect_sound(const Slicer& slicer, const Vec3& origin, const Vec3& normal) {
  const Eigen::Matrix3Xf at = corners(slicer);
  for (Eigen::Index k = 0; k < at.cols(); ++k)
    ASSERT_NEAR((at.col(k).cast<double>() - origin).dot(normal.normalized()), 0.0, 1e-4);
  std::map<std::pair<Index, Index>, int> edges;
  for (const SliceTriangle& triangle : slicer.triangles()) {
    ASSERT_GE(area_vector(triangle, at).dot(normal), -1e-4);
    for (std::size_t i = 0; i < 3; ++i) ++edges[{triangle.vertices[i], triangle.vertices[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) ASSERT_EQ(count, 1) << "a piece lies twice, or looks the other way";
}

TEST(Slice, any_plane_through_a_box_has_the_area_of_its_section) {
  const TetMesh mesh = box_mesh({0, 0, 0}, {40, 40, 40}, {5, 5, 5}, 0.15);
  Slicer slicer(mesh);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 normal(any(random), any(random), any(random));
    const Vec3 origin = Vec3::Constant(20) + 15 * Vec3(any(random), any(random), any(random));
    slicer.cut(origin, normal);
    expect_sound(slicer, origin, normal);
    EXPECT_NEAR(area(slicer, normal), 1600 * section_of_unit_cube(normal, normal.dot(origin) / 40), 0.02);
  }
}

TEST(Slice, a_plane_through_nodes_and_faces_takes_nothing_twice_and_leaves_nothing_out) {
  const TetMesh mesh = box_mesh({0, 0, 0}, {40, 40, 40}, {4, 4, 4});
  Slicer slicer(mesh);
  for (const double z : {10.0, 20.0, 30.0}) {  // whole layers of faces lie in these planes
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        const Vec3 normal = sign * Vec3::Unit(axis);
        slicer.cut(Vec3::Constant(z), normal);
        expect_sound(slicer, Vec3::Constant(z), normal);
        EXPECT_NEAR(area(slicer, normal), 1600, 1e-2);
      }
    }
  }
  // A plane through edges, nodes and diagonal faces.
  slicer.cut(Vec3::Zero(), {1, -1, 0});
  EXPECT_NEAR(area(slicer, {1, -1, 0}), 1600 * std::sqrt(2.0), 0.02);
  slicer.cut(Vec3::Constant(20), {1, 1, 1});
  EXPECT_NEAR(area(slicer, {1, 1, 1}), 1600 * 0.75 * std::sqrt(3.0), 0.02) << "a regular hexagon";
  // The outermost faces: seen from one side they are the end of the mesh, seen from the other they are just outside it.
  slicer.cut(Vec3::Zero(), Vec3::UnitZ());
  EXPECT_TRUE(slicer.triangles().empty()) << "all of the mesh is in front";
  slicer.cut(Vec3::Zero(), -Vec3::UnitZ());
  EXPECT_NEAR(area(slicer, -Vec3::UnitZ()), 1600, 1e-2);
  slicer.cut({0, 0, -5}, Vec3::UnitZ());
  EXPECT_TRUE(slicer.triangles().empty());
}

TEST(Slice, sections_of_a_ball_are_discs_and_add_up_to_its_volume) {
  const double R = 30.0;
  const TetMesh mesh = ball(R, 24);
  double volume = 0.0;
  for (Index t = 0; t < mesh.tet_count(); ++t) volume += tet_volume(mesh, t);
  Slicer slicer(mesh);
  const Vec3 normal = Vec3(1, 2, -0.5).normalized();
  for (const double d : {-20.0, 0.0, 13.0}) {
    slicer.cut(d * normal, normal);
    EXPECT_NEAR(area(slicer, normal), std::numbers::pi * (R * R - d * d), 0.01 * std::numbers::pi * R * R);
  }
  double sum = 0.0;
  const double step = 0.25;
  for (double d = -R + 0.5 * step; d < R; d += step) {
    slicer.cut(d * normal, normal);
    sum += step * area(slicer, normal);
  }
  EXPECT_NEAR(sum, volume, 1e-3 * volume);
}

TEST(Slice, regions_keep_their_shares_of_the_section) {
  TetMesh mesh = box_mesh({0, 0, 0}, {40, 40, 40}, {4, 4, 4});
  assign_regions(mesh, {"left", "right"}, [](const Vec3& x) { return x.x() < 10.0 ? 0 : 1; });
  Slicer slicer(mesh);
  slicer.cut({0, 0, 17}, Vec3::UnitZ());
  EXPECT_NEAR(area(slicer, Vec3::UnitZ(), 0), 400, 1e-2);
  EXPECT_NEAR(area(slicer, Vec3::UnitZ(), 1), 1200, 1e-2);
}

TEST(Slice, moves_with_the_material) {
  const TetMesh mesh = box_mesh({0, 0, 0}, {40, 40, 40}, {4, 4, 4}, 0.1);
  Slicer slicer(mesh);
  slicer.cut({20, 20, 20}, {0.3, 0.2, 1});
  // An affine displacement moves every point of the slice exactly: interpolation has no error.
  Mat3 G;
  G << 0.1, 0.02, 0, -0.05, 0, 0.1, 0.03, 0, -0.08;
  Eigen::Matrix3Xf u(3, static_cast<Eigen::Index>(slicer.nodes().size()));
  for (std::size_t k = 0; k < slicer.nodes().size(); ++k)
    u.col(static_cast<Eigen::Index>(k)) = (G * mesh.nodes[static_cast<std::size_t>(slicer.nodes()[k])]).cast<float>();
  const Eigen::Matrix3Xf before = corners(slicer);
  Eigen::Matrix3Xf after(3, before.cols());
  slicer.positions(u, after);
  const Eigen::Matrix3Xf expected = before + G.cast<float>() * before;
  EXPECT_LT((after - expected).cwiseAbs().maxCoeff(), 1e-4F);
  const std::set<Index> once(slicer.nodes().begin(), slicer.nodes().end());
  EXPECT_EQ(once.size(), slicer.nodes().size());
}

}  // namespace
}  // namespace stylet
