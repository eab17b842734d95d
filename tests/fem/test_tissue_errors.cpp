// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.hpp"

#include <cmath>

namespace stylet {
namespace {

using test::nodes_where;

TetMesh cube() { return box_mesh({0, 0, 0}, {40, 40, 40}, {4, 4, 4}, 0.1); }
std::vector<Index> nodes_at_zero(const TetMesh& mesh) {
  return nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
}
const Material kSoft{0.010, 0.45};

void expect_refused(const TetMesh& mesh, const std::vector<Material>& materials, const std::vector<Index>& fixed,
                    const std::vector<std::string>& parts) {
  const auto tissue = Tissue::build(mesh, materials, fixed);
  ASSERT_FALSE(tissue);
  EXPECT_EQ(tissue.error().kind, ErrorKind::input);
  EXPECT_FALSE(tissue.error().cure.empty());
  const std::string message = tissue.error().message();
  for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << message;
}

// Adds the nodes and elements of `other`. With `weld`, nodes at the same place become one.
TetMesh join(TetMesh mesh, const TetMesh& other, bool weld) {
  std::vector<Index> number;
  for (const Vec3& x : other.nodes) {
    Index found = -1;
    for (Index a = 0; weld && a < mesh.node_count(); ++a) {
      if (mesh.nodes[a] == x) found = a;
    }
    if (found < 0) {
      found = mesh.node_count();
      mesh.nodes.push_back(x);
    }
    number.push_back(found);
  }
  for (auto tet : other.tets) {
    for (Index& a : tet) a = number[a];
    mesh.tets.push_back(tet);
    mesh.tet_region.push_back(0);
  }
  return mesh;
}

TEST(TissueErrors, materials_must_match_the_regions) {
  expect_refused(cube(), {kSoft, kSoft}, nodes_at_zero(cube()), {"2 materials", "1 regions"});
}

TEST(TissueErrors, youngs_modulus_must_be_positive_and_finite) {
  for (const double young : {0.0, -0.01, HUGE_VAL, std::nan("")}) {
    expect_refused(cube(), {{young, 0.4}}, nodes_at_zero(cube()), {"region 'body'", "Young's modulus", "kPa"});
  }
  expect_refused(cube(), {{-0.01, 0.4}}, nodes_at_zero(cube()), {"is -10 kPa"});
}

TEST(TissueErrors, poisson_ratio_must_be_below_one_half) {
  for (const double poisson : {0.5, 0.7, -1.0, std::nan("")}) {
    expect_refused(cube(), {{0.01, poisson}}, nodes_at_zero(cube()), {"region 'body'", "Poisson ratio", "below 0.5"});
  }
  expect_refused(cube(), {{0.01, 0.5}}, nodes_at_zero(cube()), {"is 0.5,"});
}

TEST(TissueErrors, without_supports_the_tissue_is_not_held) {
  expect_refused(cube(), {kSoft}, {}, {"not held", "none of its nodes is fixed", "at least three nodes"});
}

TEST(TissueErrors, one_and_two_nodes_do_not_hold) {
  expect_refused(cube(), {kSoft}, {7}, {"not held", "only 1 of its nodes"});
  expect_refused(cube(), {kSoft}, {7, 20, 20}, {"not held", "only 2 of its nodes"});
}

TEST(TissueErrors, nodes_on_a_line_do_not_hold) {
  const auto edge = nodes_where(cube(), [](const Vec3& x) { return x.x() == 0.0 && x.y() == 0.0; });
  ASSERT_EQ(edge.size(), 5u);
  expect_refused(cube(), {kSoft}, edge, {"not held", "5 fixed nodes lie on one line"});
  auto plane = edge;
  plane.push_back(cube().node_count() - 1);
  EXPECT_TRUE(Tissue::build(cube(), {kSoft}, plane));
}

TEST(TissueErrors, every_connected_part_must_be_held) {
  const TetMesh mesh = join(cube(), box_mesh({60, 0, 0}, {70, 10, 10}, {2, 2, 2}), false);
  ASSERT_TRUE(check_mesh(mesh, "two bodies"));
  auto fixed = nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0 && x.x() < 50.0; });
  expect_refused(mesh, {kSoft}, fixed, {"part 2 of 2", "27 nodes around (65, 5, 5) mm", "none of its nodes"});
  fixed = nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
  EXPECT_TRUE(Tissue::build(mesh, {kSoft}, fixed));
}

TEST(TissueErrors, a_part_that_hangs_on_by_an_edge_is_found_loose) {
  // Welded only along the edge x = 40, z = 40: the second body can turn about it.
  const TetMesh mesh =
      join(box_mesh({0, 0, 0}, {40, 40, 40}, {4, 4, 4}), box_mesh({40, 0, 40}, {60, 40, 60}, {2, 4, 2}), true);
  expect_refused(mesh, {kSoft}, nodes_at_zero(mesh), {"not held", "single node or edge"});
  const TetMesh corner =
      join(box_mesh({0, 0, 0}, {40, 40, 40}, {4, 4, 4}), box_mesh({40, 40, 40}, {60, 60, 60}, {2, 2, 2}), true);
  expect_refused(corner, {kSoft}, nodes_at_zero(corner), {"not held", "single node or edge"});
  // The result must not depend on the position of its nodes in the order of elimination.
  const auto all = nodes_where(corner, [](const Vec3&) { return true; });
  const auto upper = nodes_where(corner, [](const Vec3& x) { return x.z() > 40; });
  for (const auto& corridor : {all, upper}) {
    const auto tissue = Tissue::build(corner, {kSoft}, nodes_at_zero(corner), {}, Element::p1, corridor);
    ASSERT_FALSE(tissue);
    EXPECT_NE(tissue.error().message().find("single node or edge"), std::string::npos) << tissue.error().message();
  }
}

TEST(TissueErrors, all_nodes_fixed_is_refused) {
  expect_refused(cube(), {kSoft}, nodes_where(cube(), [](const Vec3&) { return true; }), {"all 125 nodes are fixed"});
}

TEST(TissueErrors, fixed_nodes_must_exist) {
  expect_refused(cube(), {kSoft}, {0, 1, 2, 125}, {"fixed node number 125", "0 to 124"});
  expect_refused(cube(), {kSoft}, {-1, 0, 1, 2}, {"fixed node number -1"});
}

TEST(TissueErrors, a_mesh_that_was_not_checked_is_refused_not_read) {
  TetMesh mesh = cube();
  mesh.tets[3][2] = 4000;
  expect_refused(mesh, {kSoft}, {0, 1, 5}, {"tetrahedron 3 names node 4000", "check_mesh()"});
  mesh = cube();
  std::swap(mesh.tets[3][2], mesh.tets[3][1]);
  expect_refused(mesh, {kSoft}, {0, 1, 5}, {"tetrahedron 3 has a volume"});
  expect_refused(TetMesh{}, {}, {}, {"no tetrahedra"});
}

TEST(TissueErrors, stiff_and_soft_and_slender_bodies_are_not_mistaken_for_loose_ones) {
  TetMesh mesh = box_mesh({0, 0, 0}, {2, 2, 200}, {1, 1, 100});
  assign_regions(mesh, {"bone", "fat"}, [](const Vec3& x) { return x.z() > 100 ? 0 : 1; });
  const auto tissue = Tissue::build(mesh, {{1e4, 0.3}, {0.001, 0.4999}}, nodes_at_zero(mesh));
  EXPECT_TRUE(tissue) << tissue.error().message();
}

}  // namespace
}  // namespace stylet
