// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/flat_tets.hpp"
#include "stylet/geom/quality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace stylet {
namespace {

constexpr double kDegree = 180.0 / std::numbers::pi;

TEST(MeshQuality, regular_tetrahedron_is_perfect) {
  TetMesh mesh;
  mesh.regions = {"body"};
  const double a = 10.0;
  mesh.nodes = {{a, a, a}, {-a, a, -a}, {a, -a, -a}, {-a, -a, a}};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.tet_region = {0};
  if (tet_volume(mesh, 0) < 0) std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_NEAR(quality.dihedral_deg.min, std::acos(1.0 / 3.0) * kDegree, 1e-10);
  EXPECT_NEAR(quality.dihedral_deg.max, std::acos(1.0 / 3.0) * kDegree, 1e-10);
  EXPECT_NEAR(quality.edge_mm.min, 2.0 * std::sqrt(2.0) * a, 1e-12);
  EXPECT_NEAR(quality.radius_ratio_min, 1.0, 1e-12);
  EXPECT_NEAR(quality.region_volume_cc[0], 8.0 / 3.0 * a * a * a / 1000.0, 1e-12);
  EXPECT_EQ(quality.dihedral_histogram[7], 6);
}

TEST(MeshQuality, kuhn_cell_has_its_known_angles_edges_and_radii) {
  TetMesh mesh = box_mesh({0, 0, 0}, {30, 20, 20}, {3, 2, 2});
  assign_regions(mesh, {"left", "right"}, [](const Vec3& x) { return x.x() < 10 ? 0 : 1; });
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_EQ(quality.tets, 72);
  EXPECT_NEAR(quality.dihedral_deg.min, 45.0, 1e-10);
  EXPECT_NEAR(quality.dihedral_deg.max, 90.0, 1e-10);
  EXPECT_NEAR(quality.edge_mm.min, 10.0, 1e-12);
  EXPECT_NEAR(quality.edge_mm.max, 10.0 * std::sqrt(3.0), 1e-12);
  // Inradius 1 / (2 + 2 √2) and circumradius √3 / 2 in a unit cell.
  EXPECT_NEAR(quality.radius_ratio_min, 3.0 / (2.0 + 2.0 * std::sqrt(2.0)) / (std::sqrt(3.0) / 2.0), 1e-12);
  EXPECT_NEAR(quality.region_volume_cc[0], 4.0, 1e-12);
  EXPECT_NEAR(quality.region_volume_cc[1], 8.0, 1e-12);
  EXPECT_EQ(quality.region_tets[0], 24);
  EXPECT_EQ(quality.fraction_below_12_deg, 0.0);
  EXPECT_EQ(std::accumulate(quality.dihedral_histogram.begin(), quality.dihedral_histogram.end(), 0), 6 * 72);
}

TEST(NearlyFlatTets, the_worst_is_named_with_its_angle_and_place) {
  TetMesh mesh = box_mesh({0, 0, 0}, {30, 20, 20}, {3, 2, 2});
  assign_regions(mesh, {"left", "right"}, [](const Vec3& x) { return x.x() < 10 ? 0 : 1; });
  EXPECT_EQ(nearly_flat_tets(mesh).count, 0);
  EXPECT_EQ(nearly_flat_warning(mesh), "");
  // Two flat tetrahedra far from everything else: a right-angled corner of 10 mm whose fourth node is 0.4 or 0.2 mm
  // above the base.
  for (const double height : {0.4, 0.2}) {
    const Index first = mesh.node_count();
    const double x = 100 / height;
    for (const Vec3& corner : {Vec3(x, 0, 0), Vec3(x + 10, 0, 0), Vec3(x, 10, 0), Vec3(x, 0, height)})
      mesh.nodes.push_back(corner);
    mesh.tets.push_back({first, first + 1, first + 2, first + 3});
    mesh.tet_region.push_back(1);
  }
  const NearlyFlatTets flat = nearly_flat_tets(mesh);
  EXPECT_EQ(flat.count, 2);
  EXPECT_EQ(flat.worst, 73);
  // The angle between the base and the oblique face, whose foot is 10 / √2 from the corner.
  EXPECT_NEAR(flat.angle_deg, std::atan(0.2 / (10.0 / std::sqrt(2.0))) * kDegree, 1e-9);
  const std::string warning = nearly_flat_warning(mesh);
  for (const char* part : {"2 of 74", "tetrahedron 73", "1.6°", "(502.5, 2.5, 0.1)", "'right'", "optimiser"})
    EXPECT_NE(warning.find(part), std::string::npos) << warning << "\n  lacks: " << part;
}

TEST(NearlyFlatTets, begin_below_five_degrees) {
  for (const auto& [angle, count] : {std::pair(4.99, 1), std::pair(5.01, 0)}) {
    TetMesh mesh;
    mesh.regions = {"body"};
    mesh.nodes = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10.0 / std::sqrt(2.0) * std::tan(angle / kDegree)}};
    mesh.tets = {{0, 1, 2, 3}};
    mesh.tet_region = {0};
    EXPECT_EQ(nearly_flat_tets(mesh).count, count) << angle;
  }
}

TEST(MeshQuality, slivers_are_counted) {
  TetMesh mesh;
  mesh.regions = {"body"};
  mesh.nodes = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0.1}};  // four corners of a nearly flat square
  mesh.tets = {{0, 1, 2, 3}};
  mesh.tet_region = {0};
  ASSERT_GT(tet_volume(mesh, 0), 0.0);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_EQ(quality.fraction_below_12_deg, 1.0);
  EXPECT_LT(quality.dihedral_deg.min, 1.0);
  EXPECT_GT(quality.dihedral_deg.max, 178.0);
  EXPECT_LT(quality.radius_ratio_min, 0.02);
}

}  // namespace
}  // namespace stylet
