// SPDX-License-Identifier: GPL-3.0-or-later
#include "made_anatomy.hpp"
#include "mesh_checks.hpp"

namespace stylet {
namespace {

using testing::gland;
using testing::set_of;

MeshOptions nodes(Index n) {
  MeshOptions o;
  o.nodes = n;
  return o;
}

/// A gland alone, meshed once for all tests that use it.
const Result<MeshedAnatomy>& simple(Index n = 700) {
  static const auto small = mesh_contours(set_of({gland()}), nodes(700));
  static const auto large = mesh_contours(set_of({gland()}), nodes(1500));
  return n == 700 ? small : large;
}

TEST(MeshContours, a_gland_alone_gets_a_body_with_perineal_skin_and_a_band) {
  const auto& m = simple();
  ASSERT_TRUE(m.ok()) << m.error().message();
  testing::expect_kept(*m, 700);
  ASSERT_TRUE(testing::has_region(*m, "body"));
  ASSERT_TRUE(testing::has_region(*m, "band"));
  EXPECT_TRUE(testing::has_note(*m, "body"));
  EXPECT_TRUE(testing::has_note(*m, "band"));
  double lowest = HUGE_VAL;
  for (const Vec3& p : m->mesh.nodes) lowest = std::min(lowest, p.z());
  const double apex = 10 - 18;
  EXPECT_NEAR(apex - lowest, 28, 4) << "perineal skin to apex";
}

TEST(MeshContours, the_band_touches_the_gland_and_the_outer_boundary) {
  const auto& m = simple();
  ASSERT_TRUE(m.ok());
  const int band = m->mesh.region_index("band");
  const std::set<Index> of_band = testing::nodes_of(m->mesh, band);
  const std::set<Index> of_gland = testing::nodes_of(m->mesh, m->mesh.region_index("prostate"));
  int shared = 0;
  for (const Index n : of_band) shared += static_cast<int>(of_gland.count(n));
  EXPECT_GE(shared, 3);
  const Topology topology(m->mesh);
  int outside = 0;
  for (const Face& f : topology.boundary) outside += m->mesh.tet_region[f.tet] == band ? 1 : 0;
  EXPECT_GE(outside, 1);
  Vec3 middle = Vec3::Zero();
  for (const Index n : of_band) middle += m->mesh.nodes[n] / static_cast<double>(of_band.size());
  EXPECT_LT(middle.y(), -20 - 16) << "anterior of the gland";
  EXPECT_LT(middle.z(), 10) << "in its inferior half";
}

TEST(MeshContours, the_band_can_be_left_out) {
  MeshOptions o = nodes(600);
  o.stiff_band = false;
  const auto m = mesh_contours(set_of({gland()}), o);
  ASSERT_TRUE(m.ok());
  EXPECT_FALSE(testing::has_region(*m, "band"));
}

TEST(MeshContours, the_same_input_gives_the_same_mesh) {
  const auto& a = simple();
  const auto b = mesh_contours(set_of({gland()}), nodes(700));
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->mesh.nodes, b->mesh.nodes);
  EXPECT_EQ(a->mesh.tets, b->mesh.tets);
  EXPECT_EQ(a->mesh.tet_region, b->mesh.tet_region);
}

TEST(MeshContours, faces_lie_on_every_boundary_and_nodes_are_shared) {
  const auto& m = simple(1500);
  ASSERT_TRUE(m.ok());
  const Topology topology(m->mesh);
  const int prostate = m->mesh.region_index("prostate");
  double area = 0;
  for (const Face& f : topology.interfaces) {
    if (m->mesh.tet_region[f.tet] != prostate && m->mesh.tet_region[f.neighbour] != prostate) continue;
    Vec3 centre = Vec3::Zero();
    for (const Index n : f.nodes) {
      const Vec3 q = (m->mesh.nodes[n] - Vec3(5, -20, 10)).cwiseQuotient(Vec3(20, 16, 18));
      EXPECT_NEAR(q.norm(), 1, 0.08);
      centre += m->mesh.nodes[n] / 3;
    }
    const Vec3 a = m->mesh.nodes[f.nodes[1]] - m->mesh.nodes[f.nodes[0]];
    const Vec3 b = m->mesh.nodes[f.nodes[2]] - m->mesh.nodes[f.nodes[0]];
    area += 0.5 * a.cross(b).norm();
  }
  EXPECT_NEAR(area, 4060, 0.05 * 4060) << "surface of the ellipsoid, Thomsen's formula";
}

TEST(MeshContours, elements_are_finer_in_the_target_than_outside) {
  const auto& m = simple(1500);
  ASSERT_TRUE(m.ok());
  const auto mean_size = [&](const std::string& name) {
    const RegionReport& r = testing::region(*m, name);
    return std::cbrt(r.volume_cc / r.tets);
  };
  EXPECT_LT(2 * mean_size("prostate"), mean_size("body"));
}

TEST(MeshContours, the_target_takes_what_it_shares_with_other_organs_and_the_urethra_what_it_shares_with_the_target) {
  const auto m = mesh_contours(set_of({gland(), testing::tube("Urethra", Vec3(5, -20, -10), 40, 2.7, 2),
                                       testing::ellipsoid("Bladder", Vec3(5, -22, 44), Vec3(25, 22, 20), 3)}),
                               nodes(1400));
  ASSERT_TRUE(m.ok()) << m.error().message();
  testing::expect_kept(*m, 1400);
  const double whole = 4.0 / 3.0 * std::numbers::pi * 20 * 16 * 18 / 1000;
  EXPECT_NEAR(testing::region(*m, "prostate").volume_cc, whole - std::numbers::pi * 2.7 * 2.7 * 36 / 1000, 0.6);
  EXPECT_FALSE(testing::has_note(*m, "'urethra' and 'prostate' overlap")) << "it runs through the gland";
  EXPECT_TRUE(testing::has_note(*m, "'prostate' and 'bladder' overlap"));
}

TEST(MeshContours, a_body_of_the_input_is_the_outer_boundary) {
  const auto m =
      mesh_contours(set_of({gland(), testing::ellipsoid("BODY", Vec3(5, -10, 0), Vec3(60, 50, 55), 5)}), nodes(900));
  ASSERT_TRUE(m.ok()) << m.error().message();
  testing::expect_kept(*m, 900);
  EXPECT_GT(testing::region(*m, "body").input_volume_cc, 500);
  EXPECT_FALSE(testing::has_note(*m, "No body contour"));
}

TEST(MeshContours, a_very_long_body_is_cropped_around_the_anatomy_and_says_so) {
  const auto m = mesh_contours(set_of({gland(), testing::tube("External", Vec3(0, 0, -120), 700, 90, 10)}), nodes(900));
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_TRUE(testing::has_note(*m, "cropped"));
  for (const Vec3& p : m->mesh.nodes) EXPECT_LT(p.z(), 140);
  testing::expect_kept(*m, 900);
}

TEST(MeshContours, an_arm_beside_the_trunk_is_left_out) {
  Roi body = testing::tube("BODY", Vec3(0, 0, -60), 150, 70, 5);
  for (const Contour& c : testing::tube("", Vec3(150, 0, -60), 150, 20, 5).contours) body.contours.push_back(c);
  const auto m = mesh_contours(set_of({gland(), body}), nodes(900));
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_TRUE(testing::has_note(*m, "apart from the rest"));
  for (const Vec3& p : m->mesh.nodes) EXPECT_LT(p.x(), 80);
  testing::expect_kept(*m, 900);
}

TEST(MeshContours, a_contour_written_twice_counts_once) {
  Roi twice = gland();
  for (const Contour& c : gland().contours) twice.contours.push_back(c);
  const auto m = mesh_contours(set_of({twice}), nodes(700));
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_EQ(m->mesh.nodes, simple()->mesh.nodes);
}

TEST(MeshContours, an_organ_with_a_hole_keeps_the_hole) {
  Roi ring = testing::tube("Rectum", Vec3(5, 20, -10), 40, 11, 4);
  for (const Contour& c : testing::tube("", Vec3(5, 20, -10), 40, 6, 4).contours) ring.contours.push_back(c);
  const auto m = mesh_contours(set_of({gland(), ring}), nodes(1400));
  ASSERT_TRUE(m.ok()) << m.error().message();
  testing::expect_kept(*m, 1400);
  EXPECT_NEAR(testing::region(*m, "rectum").input_volume_cc, std::numbers::pi * (121 - 36) * 44 / 1000, 0.5);
  const int rectum = m->mesh.region_index("rectum");
  for (Index t = 0; t < m->mesh.tet_count(); ++t) {
    if (m->mesh.tet_region[t] != rectum) continue;
    Vec3 c = Vec3::Zero();
    for (const Index n : m->mesh.tets[t]) c += m->mesh.nodes[n] / 4;
    EXPECT_GT((c - Vec3(5, 20, c.z())).norm(), 4.5);
  }
}

TEST(MeshContours, contours_on_oblique_slices_give_the_moved_gland) {
  const Mat3 turn = Eigen::AngleAxisd(0.4, Vec3(1, 0.3, 0.2).normalized()).toRotationMatrix();
  ContourSet set = set_of({gland()});
  for (Contour& c : set.rois[0].contours) {
    for (Vec3& p : c.points) p = turn * p;
  }
  const auto m = mesh_contours(set, nodes(700));
  ASSERT_TRUE(m.ok()) << m.error().message();
  testing::expect_kept(*m, 700);
  Vec3 centre = Vec3::Zero();
  const std::set<Index> used = testing::nodes_of(m->mesh, m->mesh.region_index("prostate"));
  for (const Index n : used) centre += m->mesh.nodes[n] / static_cast<double>(used.size());
  EXPECT_LT((centre - turn * Vec3(5, -20, 10)).norm(), 1.5);
}

TEST(MeshContours, a_planning_volume_stands_in_only_where_the_gland_is_not_drawn) {
  const auto both = mesh_contours(set_of({gland(), gland("PTV")}), nodes(600));
  ASSERT_TRUE(both.ok());
  EXPECT_FALSE(testing::has_region(*both, "ptv"));
  EXPECT_TRUE(testing::has_note(*both, "planning volume"));
  Roi empty;
  empty.name = "PROS";
  const auto alone = mesh_contours(set_of({empty, gland("PTV")}), nodes(600));
  ASSERT_TRUE(alone.ok());
  EXPECT_TRUE(testing::has_region(*alone, "prostate"));
  EXPECT_TRUE(testing::has_note(*alone, "'PTV' is taken as the gland"));
}

TEST(MeshContours, regions_are_taken_by_the_names_the_user_gives) {
  MeshOptions o = nodes(600);
  o.regions = {{"my volume", "prostate"}};
  const Roi bladder = testing::ellipsoid("Bladder", Vec3(5, -22, 48), Vec3(18, 16, 14), 3);
  const auto m = mesh_contours(set_of({gland("my volume"), bladder}), o);
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_TRUE(testing::has_region(*m, "prostate"));
  EXPECT_TRUE(testing::has_region(*m, "bladder"));
}

TEST(MeshContours, zones_that_make_up_the_gland_share_it_without_gaps) {
  Roi front = testing::ellipsoid("TZ", Vec3(5, -20, 10), Vec3(20, 16, 18), 3);
  Roi back = testing::ellipsoid("PZ", Vec3(5, -20, 10), Vec3(20, 16, 18), 3);
  for (Contour& c : front.contours) {
    for (Vec3& p : c.points) p.y() = std::min(p.y(), -17.0);
  }
  for (Contour& c : back.contours) {
    for (Vec3& p : c.points) p.y() = std::max(p.y(), -17.0);
  }
  std::erase_if(back.contours, [](const Contour& c) { return cull(c, 0.1).points.size() < 3; });
  const auto m = mesh_contours(set_of({gland(), front, back}), nodes(1200));
  ASSERT_TRUE(m.ok()) << m.error().message();
  testing::expect_kept(*m, 1200);
  EXPECT_FALSE(testing::has_region(*m, "prostate"));
  EXPECT_TRUE(testing::has_note(*m, "zones make up the prostate"));
}

TEST(MeshContours, the_paper_preset_meshes_the_gland_and_its_surroundings_only) {
  MeshOptions o;
  o.preset = MeshPreset::paper;
  const auto m =
      mesh_contours(set_of({gland(), testing::ellipsoid("Bladder", Vec3(5, -22, 44), Vec3(25, 22, 20), 3)}), o);
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_NEAR(m->mesh.node_count(), 570, 15);
  EXPECT_FALSE(testing::has_region(*m, "bladder"));
  testing::expect_kept(*m, 570, {.smallest_angle = 9.9, .largest_angle = 168, .total_volume = 0.1});
}

TEST(MeshContours, report_counts_contour_points_and_distances) {
  const auto& m = simple();
  ASSERT_TRUE(m.ok());
  EXPECT_EQ(m->report.contour_points, 12 * 48);
  EXPECT_GT(m->report.contour_points_kept, 12 * 8);
  EXPECT_LT(m->report.contour_points_kept, m->report.contour_points);
  EXPECT_GT(m->report.surface_mean_mm, 0);
  EXPECT_LT(m->report.surface_mean_mm, 1.0);
  EXPECT_GE(m->report.surface_max_mm, m->report.surface_mean_mm);
  EXPECT_GT(m->report.seconds, 0);
}

}  // namespace
}  // namespace stylet
