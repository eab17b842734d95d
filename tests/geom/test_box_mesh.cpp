// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/box_mesh.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

double total_volume(const TetMesh& mesh) {
  double volume = 0.0;
  for (Index t = 0; t < mesh.tet_count(); ++t) volume += tet_volume(mesh, t);
  return volume;
}

TEST(BoxMesh, fills_the_box_with_positive_conforming_tetrahedra) {
  const TetMesh mesh = box_mesh({-10, 5, 100}, {20, 25, 160}, {3, 4, 5});
  EXPECT_EQ(mesh.node_count(), 4 * 5 * 6);
  EXPECT_EQ(mesh.tet_count(), 6 * 3 * 4 * 5);
  EXPECT_NEAR(total_volume(mesh), 30.0 * 20.0 * 60.0, 1e-9);
  const auto checked = check_mesh(mesh, "box");
  EXPECT_TRUE(checked) << checked.error().message();
}

TEST(BoxMesh, jitter_keeps_every_tetrahedron_positive_and_the_outer_surface) {
  const TetMesh mesh = box_mesh({0, 0, 0}, {50, 60, 70}, {10, 9, 8}, 0.15);
  const TetMesh plain = box_mesh({0, 0, 0}, {50, 60, 70}, {10, 9, 8});
  for (Index t = 0; t < mesh.tet_count(); ++t) ASSERT_GT(tet_volume(mesh, t), 0.0);
  EXPECT_NEAR(total_volume(mesh), 50.0 * 60.0 * 70.0, 1e-8);
  EXPECT_TRUE(check_mesh(mesh, "box"));
  EXPECT_EQ(mesh.nodes.front(), plain.nodes.front());
  EXPECT_EQ(mesh.nodes.back(), Vec3(50, 60, 70));
  EXPECT_NE(mesh.nodes[5 + 11 * (5 + 10 * 4)], plain.nodes[5 + 11 * (5 + 10 * 4)]);
}

TEST(BoxMesh, is_the_same_on_every_run) {
  EXPECT_EQ(box_mesh({0, 0, 0}, {10, 10, 10}, {4, 4, 4}, 0.1).nodes,
            box_mesh({0, 0, 0}, {10, 10, 10}, {4, 4, 4}, 0.1).nodes);
}

TEST(BoxMesh, regions_follow_the_centroids) {
  TetMesh mesh = box_mesh({0, 0, 0}, {10, 10, 10}, {2, 2, 2});
  assign_regions(mesh, {"lower", "upper"}, [](const Vec3& x) { return x.z() < 5.0 ? 0 : 1; });
  EXPECT_EQ(std::count(mesh.tet_region.begin(), mesh.tet_region.end(), 0), 24);
  EXPECT_EQ(mesh.region_index("upper"), 1);
  EXPECT_EQ(mesh.region_index("Upper"), -1);
}

}  // namespace
}  // namespace stylet
