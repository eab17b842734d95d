// SPDX-License-Identifier: GPL-3.0-or-later
// Tests surfaces that move with a mesh, and their lists of numbers in files.
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/tied_surface.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace stylet {
namespace {

/// A box of some hundred elements with a surface of random points, some of them up to 2 mm outside of it.
TetMesh box_with_surface() {
  TetMesh mesh = box_mesh(Vec3::Constant(-20.0), Vec3::Constant(20.0), {4, 4, 4});
  std::mt19937 random(58);
  std::uniform_real_distribution<double> place(-22.0, 22.0);
  Surface surface{.name = mesh.regions[0], .points = {}, .triangles = {}};
  for (int n = 0; n < 300; ++n) surface.points.emplace_back(place(random), place(random), place(random));
  for (Index n = 0; n + 2 < 300; ++n) surface.triangles.push_back({n, n + 1, n + 2});
  mesh.surfaces = {surface};
  return mesh;
}

TEST(TiedSurface, is_at_rest_where_it_was_given_and_moves_as_the_tissue_does) {
  const TetMesh mesh = box_with_surface();
  const Topology topology(mesh);
  const auto tied = tie_surfaces(Locator(mesh, topology));
  ASSERT_EQ(tied.size(), 1U);
  Mat3 strain;
  strain << 0.02, 0.01, 0.0, -0.03, 0.01, 0.02, 0.0, 0.04, -0.02;
  const Vec3 shift(1.0, -2.0, 3.0);
  VecX u(3 * mesh.node_count());
  for (Index n = 0; n < mesh.node_count(); ++n)
    u.segment<3>(3 * n) = shift + strain * mesh.nodes[static_cast<std::size_t>(n)];
  const auto rest = tied[0].positions(mesh, VecX::Zero(u.size()));
  const auto moved = tied[0].positions(mesh, u);
  for (std::size_t n = 0; n < rest.size(); ++n) {
    const Vec3& x = mesh.surfaces[0].points[n];
    EXPECT_LT((rest[n] - x).norm(), 1e-9);
    EXPECT_LT((moved[n] - (x + shift + strain * x)).norm(), 1e-9);
  }
}

TEST(TiedSurface, a_mesh_without_surfaces_ties_none) {
  TetMesh mesh = box_with_surface();
  mesh.surfaces.clear();
  const Topology topology(mesh);
  EXPECT_TRUE(tie_surfaces(Locator(mesh, topology)).empty());
}

TEST(FlatSurfaces, become_the_surfaces_again_and_are_refused_where_they_do_not_fit) {
  const Surface one{.name = "a", .points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
  const Surface none{.name = "b", .points = {}, .triangles = {}};
  const std::vector<std::string> names{"a", "b", "c"};
  const FlatSurfaces flat = flatten(std::vector{one, none, one});
  const auto back = unflatten(flat, names);
  ASSERT_TRUE(back);
  ASSERT_EQ(back->size(), 3U);
  EXPECT_EQ((*back)[2].name, "c");
  EXPECT_EQ((*back)[2].points, one.points);
  EXPECT_EQ((*back)[2].triangles, one.triangles);
  EXPECT_TRUE((*back)[1].points.empty());

  const auto refused = [&](auto change) {
    FlatSurfaces damaged = flat;
    change(damaged);
    return !unflatten(damaged, names);
  };
  EXPECT_TRUE(refused([](FlatSurfaces& f) { f.triangles[4] = 3; }));
  EXPECT_TRUE(refused([](FlatSurfaces& f) { f.triangles[4] = -1; }));
  EXPECT_TRUE(refused([](FlatSurfaces& f) { f.sizes[0] = 4; }));
  EXPECT_TRUE(refused([](FlatSurfaces& f) { f.sizes[1] = -1; }));
  EXPECT_TRUE(refused([](FlatSurfaces& f) { f.sizes.pop_back(); }));
  EXPECT_TRUE(refused([](FlatSurfaces& f) { f.points_mm.push_back(0.0F); }));
  EXPECT_TRUE(refused([](FlatSurfaces& f) { f.points_mm[2] = std::numeric_limits<float>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](FlatSurfaces& f) { f.points_mm[2] = 1e9F; }));
}

}  // namespace
}  // namespace stylet
