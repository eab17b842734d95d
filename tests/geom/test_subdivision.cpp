// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/subdivision.hpp"

#include "stylet/geom/box_mesh.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stylet {
namespace {

TetMesh two_part_box() {
  TetMesh mesh = box_mesh({0, 0, 0}, {30, 20, 10}, {3, 2, 2}, 0.15);
  assign_regions(mesh, {"body", "prostate"}, [](const Vec3& x) { return x.x() < 15.0 ? 0 : 1; });
  return mesh;
}

TEST(Subdivision, is_a_sound_mesh_with_eight_parts_of_each_tetrahedron_that_fill_it) {
  const TetMesh mesh = two_part_box();
  const Subdivision fine = subdivide(mesh);
  const auto sound = check_mesh(fine.mesh, "the subdivision");
  ASSERT_TRUE(sound) << sound.error().message();
  ASSERT_EQ(fine.mesh.tet_count(), 8 * mesh.tet_count());
  EXPECT_EQ(fine.mesh.node_count(), mesh.node_count() + static_cast<Index>(fine.ends.size()));
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    double volume = 0.0;
    for (Index k = 0; k < 8; ++k) {
      EXPECT_NEAR(tet_volume(fine.mesh, 8 * t + k), tet_volume(mesh, t) / 8.0, 1e-12 * tet_volume(mesh, t));
      EXPECT_EQ(fine.mesh.tet_region[static_cast<std::size_t>(8 * t + k)],
                mesh.tet_region[static_cast<std::size_t>(t)]);
      volume += tet_volume(fine.mesh, 8 * t + k);
    }
    EXPECT_NEAR(volume, tet_volume(mesh, t), 1e-12 * volume);
  }
}

TEST(Subdivision, has_every_material_point_where_it_was) {
  const TetMesh mesh = two_part_box();
  const Subdivision fine = subdivide(mesh);
  const auto place = [](const TetMesh& m, const MaterialPoint& at) {
    Vec3 x = Vec3::Zero();
    for (int i = 0; i < 4; ++i) {
      const Index corner = m.tets[static_cast<std::size_t>(at.tet)][static_cast<std::size_t>(i)];
      x += at.weights[i] * m.nodes[static_cast<std::size_t>(corner)];
    }
    return x;
  };
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int n = 0; n < 2000; ++n) {
    Vec4 weights(share(random), share(random), share(random), share(random));
    if (n % 5 == 0) weights[n % 4] = 0.0;  // on a face
    weights /= weights.sum();
    const MaterialPoint at{static_cast<Index>(n % mesh.tet_count()), weights};
    const MaterialPoint finer = in_subdivision(at);
    EXPECT_EQ(finer.tet / 8, at.tet);
    EXPECT_GE(finer.weights.minCoeff(), -1e-12);
    EXPECT_NEAR(finer.weights.sum(), 1.0, 1e-12);
    EXPECT_LT((place(fine.mesh, finer) - place(mesh, at)).norm(), 1e-11);
  }
}

}  // namespace
}  // namespace stylet
