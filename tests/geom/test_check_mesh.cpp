// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/box_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stylet {
namespace {

TetMesh good() { return box_mesh({0, 0, 0}, {40, 40, 40}, {4, 4, 4}); }

// The mesh is refused as bad input with a message that contains all given parts.
void expect_refused(const TetMesh& mesh, const std::vector<std::string>& parts) {
  const auto result = check_mesh(mesh, "case.msh");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::input);
  const std::string message = result.error().message();
  EXPECT_EQ(message.find("case.msh"), 0u) << message;
  EXPECT_FALSE(result.error().cure.empty());
  for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(CheckMesh, accepts_a_good_mesh) { EXPECT_TRUE(check_mesh(good(), "case.msh")); }

TEST(CheckMesh, refuses_an_empty_mesh) {
  expect_refused(TetMesh{}, {"empty", "0 nodes"});
  TetMesh mesh = good();
  mesh.tets.clear();
  mesh.tet_region.clear();
  expect_refused(mesh, {"empty", "125 nodes and 0 tetrahedra"});
}

TEST(CheckMesh, refuses_missing_regions) {
  TetMesh mesh = good();
  mesh.tet_region.pop_back();
  expect_refused(mesh, {"383 of 384"});
  mesh = good();
  mesh.regions.clear();
  expect_refused(mesh, {"0 regions"});
}

TEST(CheckMesh, refuses_bad_region_numbers) {
  TetMesh mesh = good();
  mesh.tet_region[17] = 1;
  expect_refused(mesh, {"tetrahedron 17", "region number 1", "expected 0 to 0"});
}

TEST(CheckMesh, refuses_node_numbers_out_of_range) {
  TetMesh mesh = good();
  mesh.tets[20][2] = 125;
  expect_refused(mesh, {"tetrahedron 20", "node number 125", "expected 0 to 124"});
  mesh.tets[20][2] = -1;
  expect_refused(mesh, {"tetrahedron 20", "node number -1"});
}

TEST(CheckMesh, refuses_not_a_number_and_infinity) {
  TetMesh mesh = good();
  mesh.nodes[31].y() = std::nan("");
  expect_refused(mesh, {"node 31", "not a finite number", "nan"});
  mesh.nodes[31].y() = HUGE_VAL;
  expect_refused(mesh, {"node 31", "not a finite number", "inf"});
}

TEST(CheckMesh, refuses_units_off_by_a_thousand) {
  TetMesh mesh = good();
  for (Vec3& x : mesh.nodes) x /= 1000.0;
  expect_refused(mesh, {"0.04 mm across", "in metres", "not in mm"});
  mesh = good();
  for (Vec3& x : mesh.nodes) x *= 1000.0;
  expect_refused(mesh, {"4e+04 mm across", "in micrometres", "not in mm"});
}

TEST(CheckMesh, refuses_a_node_named_twice) {
  TetMesh mesh = good();
  mesh.tets[9][3] = mesh.tets[9][1];
  expect_refused(mesh, {"tetrahedron 9", "node " + std::to_string(mesh.tets[9][1]) + " is named twice"});
}

TEST(CheckMesh, refuses_duplicate_tetrahedra) {
  TetMesh mesh = good();
  const auto [a, b, c, d] = mesh.tets[3];
  mesh.tets.push_back({b, c, a, d});
  mesh.tet_region.push_back(0);
  expect_refused(mesh, {"tetrahedron 384", "duplicate of tetrahedron 3"});
}

TEST(CheckMesh, refuses_inverted_tetrahedra) {
  TetMesh mesh = good();
  std::swap(mesh.tets[50][0], mesh.tets[50][1]);
  std::swap(mesh.tets[60][0], mesh.tets[60][1]);
  expect_refused(mesh, {"tetrahedron 50", "inverted", "-166.667 mm³", "1 more like it"});
}

TEST(CheckMesh, refuses_a_mesh_listed_in_the_opposite_order_with_its_own_message) {
  TetMesh mesh = good();
  for (auto& tet : mesh.tets) std::swap(tet[0], tet[1]);
  expect_refused(mesh, {"all 384 tetrahedra are inverted", "opposite order"});
}

TEST(CheckMesh, refuses_flat_tetrahedra) {
  TetMesh mesh = good();
  const auto& tet = mesh.tets[70];
  mesh.nodes.push_back((mesh.nodes[tet[0]] + mesh.nodes[tet[1]] + mesh.nodes[tet[2]]) / 3.0);
  mesh.tets.push_back({tet[0], tet[1], tet[2], 125});
  mesh.tet_region.push_back(0);
  expect_refused(mesh, {"tetrahedron 384", "it is flat", "longest edge"});
}

TEST(CheckMesh, refuses_a_face_of_three_tetrahedra) {
  TetMesh mesh = good();
  // Attach a tetrahedron to a face inside the box, like a fin.
  const auto& tet = mesh.tets[150];
  mesh.nodes.push_back(mesh.nodes[tet[0]] + Vec3(1, 2, 3));
  mesh.tets.push_back({tet[1], tet[2], tet[3], 125});
  if (tet_volume(mesh, 384) < 0) std::swap(mesh.tets[384][0], mesh.tets[384][1]);
  mesh.tet_region.push_back(0);
  expect_refused(mesh, {"face of nodes", "shared by 3 tetrahedra", "384"});
}

TEST(CheckMesh, refuses_tetrahedra_overlapping_at_a_face) {
  TetMesh mesh;
  mesh.regions = {"body"};
  mesh.nodes = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {2, 2, 10}};
  mesh.tets = {{0, 1, 2, 3}, {0, 1, 2, 4}};
  mesh.tet_region = {0, 0};
  expect_refused(mesh, {"face of nodes 0, 1, 2", "tetrahedra 0 and 1", "same side"});
}

TEST(CheckMesh, refuses_unreferenced_nodes) {
  TetMesh mesh = good();
  mesh.nodes.push_back({1, 2, 3});
  mesh.nodes.push_back({4, 5, 6});
  expect_refused(mesh, {"node 125", "no tetrahedron uses", "(1, 2, 3) mm", "1 more like it"});
}

}  // namespace
}  // namespace stylet
