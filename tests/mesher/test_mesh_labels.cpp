// SPDX-License-Identifier: GPL-3.0-or-later
#include "made_anatomy.hpp"
#include "mesh_checks.hpp"

namespace stylet {
namespace {

MeshOptions zones(Index n) {
  MeshOptions o;
  o.nodes = n;
  o.regions = {{"1", "peripheral_zone"}, {"2", "transition_zone"}};
  return o;
}

TEST(MeshLabels, two_zones_share_their_boundary_and_keep_their_volumes) {
  const auto m = mesh_labels(testing::two_zones(), zones(1000));
  ASSERT_TRUE(m.ok()) << m.error().message();
  testing::expect_kept(*m, 1000);
  const Topology topology(m->mesh);
  const int a = m->mesh.region_index("peripheral_zone"), b = m->mesh.region_index("transition_zone");
  int between = 0;
  for (const Face& f : topology.interfaces) {
    const int r = m->mesh.tet_region[f.tet], s = m->mesh.tet_region[f.neighbour];
    between += (r == a && s == b) || (r == b && s == a) ? 1 : 0;
  }
  EXPECT_GT(between, 50);
}

TEST(MeshLabels, an_oblique_left_handed_frame_gives_the_moved_zones) {
  const Mat3 turn = Eigen::AngleAxisd(0.3, Vec3(0.2, 1, 0.1).normalized()).toRotationMatrix();
  Mat3 mirrored = turn;
  mirrored.col(0) *= -1;
  ASSERT_LT(mirrored.determinant(), 0);
  const Vec3 origin(100, -50, 25);
  const LabelImage image = testing::two_zones(mirrored, origin);
  const auto m = mesh_labels(image, zones(1200));
  ASSERT_TRUE(m.ok()) << m.error().message();
  testing::expect_kept(*m, 1200);
  // The image's label at the centroid of each element is the element's region, except for a rim of one voxel.
  int right = 0, all = 0;
  for (Index t = 0; t < m->mesh.tet_count(); ++t) {
    Vec3 c = Vec3::Zero();
    for (const Index n : m->mesh.tets[t]) c += m->mesh.nodes[n] / 4;
    const Vec3 v = (mirrored.transpose() * (c - origin)).cwiseQuotient(image.spacing);
    const std::array<long, 3> i{std::lround(v.x()), std::lround(v.y()), std::lround(v.z())};
    int label = 0;
    if (i[0] >= 0 && i[1] >= 0 && i[2] >= 0 && i[0] < 64 && i[1] < 56 && i[2] < 14) {
      label = image.labels[static_cast<std::size_t>((i[2] * 56 + i[1]) * 64 + i[0])];
    }
    const std::string& name = m->mesh.regions[m->mesh.tet_region[t]];
    ++all;
    right += (label == 1) == (name == "peripheral_zone") && (label == 2) == (name == "transition_zone") ? 1 : 0;
  }
  EXPECT_GT(right, 0.97 * all);
}

TEST(MeshLabels, the_slice_axis_may_be_any_image_axis) {
  const LabelImage image = testing::two_zones();
  LabelImage turned = image;  // (i, j, k) → (k, i, j)
  turned.size = {14, 64, 56};
  turned.spacing = Vec3(3.5, 0.8, 0.8);
  turned.direction.col(0) = Vec3::UnitZ();
  turned.direction.col(1) = Vec3::UnitX();
  turned.direction.col(2) = Vec3::UnitY();
  for (std::size_t k = 0; k < 14; ++k) {
    for (std::size_t j = 0; j < 56; ++j) {
      for (std::size_t i = 0; i < 64; ++i) {
        turned.labels[(j * 64 + i) * 14 + k] = image.labels[(k * 56 + j) * 64 + i];
      }
    }
  }
  const auto a = mesh_labels(image, zones(800));
  const auto b = mesh_labels(turned, zones(800));
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->mesh.nodes, b->mesh.nodes);
  EXPECT_EQ(a->mesh.tets, b->mesh.tets);
}

TEST(MeshLabels, unnamed_labels_are_all_the_target) {
  MeshOptions o;
  o.nodes = 900;
  const auto m = mesh_labels(testing::two_zones(), o);
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_TRUE(testing::has_region(*m, "label_1"));
  EXPECT_TRUE(testing::has_region(*m, "label_2"));
  EXPECT_TRUE(testing::has_note(*m, "all labels together count as the target"));
}

TEST(MeshLabels, names_in_the_file_are_used) {
  LabelImage image = testing::two_zones();
  image.names = {{1, "PZ"}, {2, "Transition Zone"}};
  MeshOptions o;
  o.nodes = 900;
  const auto m = mesh_labels(image, o);
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_TRUE(testing::has_region(*m, "peripheral_zone"));
  EXPECT_TRUE(testing::has_region(*m, "transition_zone"));
}

TEST(MeshLabels, a_labelled_body_is_the_outer_boundary) {
  LabelImage image = testing::two_zones();
  image.size = {64, 56, 14};
  std::size_t n = 0;
  for (int k = 0; k < 14; ++k) {
    for (int j = 0; j < 56; ++j) {
      for (int i = 0; i < 64; ++i, ++n) {
        if (image.labels[n] == 0 && i > 1 && i < 62 && j > 1 && j < 54) image.labels[n] = 3;
      }
    }
  }
  image.names = {{1, "PZ"}, {2, "TZ"}, {3, "Body"}};
  MeshOptions o;
  o.nodes = 1200;
  const auto m = mesh_labels(image, o);
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_GT(testing::region(*m, "body").input_volume_cc, 50);
  testing::expect_kept(*m, 1200);
}

TEST(MeshLabels, a_lesion_labelled_in_the_gland_leaves_no_hole_in_it) {
  LabelImage image = testing::two_zones();
  const LabelImage without = image;
  for (int k = 6; k < 9; ++k) {
    for (int j = 12; j < 22; ++j) {
      for (int i = 26; i < 36; ++i) image.labels[static_cast<std::size_t>((k * 56 + j) * 64 + i)] = 3;
    }
  }
  image.names = {{1, "PZ"}, {2, "TZ"}, {3, "GTV"}};
  MeshOptions o;
  o.nodes = 900;
  const auto m = mesh_labels(image, o), same = mesh_labels(without, zones(900));
  ASSERT_TRUE(m.ok()) << m.error().message();
  ASSERT_TRUE(same.ok()) << same.error().message();
  EXPECT_EQ(m->mesh.nodes, same->mesh.nodes);
  EXPECT_TRUE(testing::has_note(*m, "'GTV' is taken as part of transition_zone"));
}

TEST(MeshLabels, a_label_left_out_of_a_body_is_tissue_of_the_body) {
  LabelImage image = testing::two_zones();
  std::size_t n = 0;
  for (int k = 0; k < 14; ++k) {
    for (int j = 0; j < 56; ++j) {
      for (int i = 0; i < 64; ++i, ++n) {
        if (image.labels[n] == 0 && i > 1 && i < 62 && j > 1 && j < 54) image.labels[n] = 3;
      }
    }
  }
  image.names = {{1, "PZ"}, {2, "TZ"}, {3, "Body"}, {4, "Rectum"}};
  LabelImage with_rectum = image;
  for (int k = 3; k < 11; ++k) {
    for (int j = 46; j < 53; ++j) {
      for (int i = 4; i < 14; ++i) with_rectum.labels[static_cast<std::size_t>((k * 56 + j) * 64 + i)] = 4;
    }
  }
  MeshOptions o;
  o.nodes = 1200;
  const auto body = mesh_labels(image, o);
  o.skip = {"Rectum"};
  const auto skipped = mesh_labels(with_rectum, o);
  ASSERT_TRUE(body.ok()) << body.error().message();
  ASSERT_TRUE(skipped.ok()) << skipped.error().message();
  const auto &a = testing::region(*body, "body"), &b = testing::region(*skipped, "body");
  EXPECT_NEAR(b.input_volume_cc, a.input_volume_cc, 1e-6 * a.input_volume_cc);
  EXPECT_NEAR(b.volume_cc, a.volume_cc, 0.01 * a.volume_cc);
}

TEST(MeshLabels, stray_voxels_and_labels_thinner_than_a_voxel_are_left_out_with_a_note) {
  LabelImage image = testing::two_zones();
  image.labels[(2 * 56 + 3) * 64 + 4] = 2;    // far from the gland
  image.labels[(7 * 56 + 28) * 64 + 50] = 9;  // in the middle of the gland, a label of one voxel
  MeshOptions o;
  o.nodes = 700;
  const auto small = mesh_labels(image, o);
  ASSERT_TRUE(small.ok()) << small.error().message();
  EXPECT_TRUE(testing::has_note(*small, "'label_9' has only"));
  EXPECT_FALSE(testing::has_region(*small, "label_9"));
  Eigen::AlignedBox3d box;
  for (const Index n : testing::nodes_of(small->mesh, small->mesh.region_index("label_2")))
    box.extend(small->mesh.nodes[n]);
  EXPECT_LT(box.sizes().x(), 45);
}

TEST(MeshLabels, the_paper_preset_joins_the_zones) {
  MeshOptions o = zones(0);
  o.preset = MeshPreset::paper;
  const auto m = mesh_labels(testing::two_zones(), o);
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_NEAR(m->mesh.node_count(), 570, 15);
  EXPECT_TRUE(testing::has_region(*m, "prostate"));
  EXPECT_FALSE(testing::has_region(*m, "peripheral_zone"));
}

}  // namespace
}  // namespace stylet
