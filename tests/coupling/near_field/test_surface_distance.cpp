// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/surface_distance.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/topology.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stylet {
namespace {

/// Distance to the outer faces of a box from −10 to 10 mm.
SurfaceDistance box_surface(const TetMesh& mesh) {
  std::vector<std::array<Index, 3>> triangles;
  for (const Face& face : Topology(mesh).boundary) triangles.push_back(face.nodes);
  return {mesh.nodes, std::move(triangles)};
}

TEST(SurfaceDistance, inside_a_box_is_that_to_its_nearest_face) {
  const TetMesh mesh = box_mesh(Vec3::Constant(-10), Vec3::Constant(10), {3, 4, 5}, 0.0);
  const SurfaceDistance surface = box_surface(mesh);
  for (const Vec3& x : {Vec3(1, 2, -7), Vec3(-9.5, 0, 3), Vec3(0.1, 9.9, 0.2)}) {
    int axis = 0;
    const double depth = 10.0 - x.cwiseAbs().maxCoeff(&axis);
    const NearSurface nearest = surface.nearest(x);
    EXPECT_NEAR(nearest.depth, depth, 1e-12);
    EXPECT_NEAR(nearest.inwards[axis], x[axis] > 0.0 ? -1.0 : 1.0, 1e-12);
  }
}

TEST(SurfaceDistance, on_a_face_the_normal_points_inwards) {
  const TetMesh mesh = box_mesh(Vec3::Constant(-10), Vec3::Constant(10), {3, 4, 5}, 0.0);
  const SurfaceDistance surface = box_surface(mesh);
  const NearSurface nearest = surface.nearest({0.3, -0.2, 10.0});
  EXPECT_EQ(nearest.depth, 0.0);
  EXPECT_NEAR(nearest.inwards.z(), -1.0, 1e-12);
}

TEST(SurfaceDistance, the_opposite_face_of_a_box_is_the_one_that_faces_the_nearest) {
  const TetMesh mesh = box_mesh(Vec3::Constant(-10), Vec3::Constant(10), {3, 4, 5}, 0.0);
  const SurfaceDistance surface = box_surface(mesh);
  for (const Vec3& x : {Vec3(1, 2, -7), Vec3(-9.5, 0, 3), Vec3(0.1, 9.9, 0.2), Vec3(0.3, -0.2, 10.0)}) {
    int axis = 0;
    const double depth = 10.0 - x.cwiseAbs().maxCoeff(&axis);
    const NearSurface nearest = surface.nearest(x);
    const NearSurface opposite = surface.opposite(x, nearest.inwards);
    // At the box's edges a normal is the mean of two faces' normals, so a face at an angle counts as a little nearer.
    EXPECT_NEAR(opposite.depth, 20.0 - depth, 0.2) << x.transpose();
    EXPECT_LT(opposite.inwards.dot(nearest.inwards), -0.9) << x.transpose();
  }
}

TEST(SurfaceDistance, on_a_hollow_surface_its_own_neighbours_are_not_the_opposite_one) {
  // A sphere, seen from points on its own triangles.
  TetMesh mesh = box_mesh(Vec3::Constant(-10), Vec3::Constant(10), {8, 8, 8}, 0.0);
  for (Vec3& x : mesh.nodes) {
    const double out = x.cwiseAbs().maxCoeff();
    if (out > 0.0) x *= out / x.norm();
  }
  const SurfaceDistance surface = box_surface(mesh);
  for (const Face& face : Topology(mesh).boundary) {
    const Vec3 x = (mesh.nodes[face.nodes[0]] + mesh.nodes[face.nodes[1]] + mesh.nodes[face.nodes[2]]) / 3.0;
    EXPECT_GT(surface.opposite(x, surface.nearest(x).inwards).depth, 10.0);
  }
}

TEST(SurfaceDistance, without_triangles_nothing_is_near) {
  const std::vector<Vec3> nodes{Vec3::Zero()};
  const SurfaceDistance surface(nodes, {});
  EXPECT_TRUE(std::isinf(surface.nearest(Vec3::Zero()).depth));
}

}  // namespace
}  // namespace stylet
