// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.hpp"

#include "stylet/fem/compliance_store.hpp"

namespace stylet {
namespace {

std::shared_ptr<const Tissue> two_regions() {
  TetMesh mesh = box_mesh({0, 0, 0}, {50, 50, 50}, {7, 7, 7}, 0.15);
  assign_regions(mesh, {"fat", "gland"}, [](const Vec3& x) { return x.x() > 25 ? 0 : 1; });
  const auto fixed = test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
  return std::make_shared<const Tissue>(test::build(std::move(mesh), {{0.01, 0.49}, {0.05, 0.4}}, fixed));
}

// Displacement of a per force on b, from a separate solve.
Mat3 solved(const Tissue& tissue, Index a, Index b) {
  MatX f = MatX::Zero(3 * Eigen::Index{tissue.displacement_nodes()}, 3);
  f.middleRows<3>(3 * Eigen::Index{b}).setIdentity();
  return tissue.solve(f).middleRows<3>(3 * Eigen::Index{a});
}

TEST(ComplianceStore, blocks_are_those_of_the_factor_however_they_were_added) {
  const auto tissue = two_regions();
  ComplianceStore store(tissue);
  std::vector<Index> nodes;
  for (Index a = 3; a < tissue->mesh().node_count(); a += 4) nodes.push_back(a);
  ASSERT_GT(nodes.size(), 100u);  // more than one batch
  const std::span<const Index> all(nodes);
  store.add_nodes(all.first(10));
  store.add_nodes(all.first(80));
  store.add_nodes(all);
  store.add_nodes(all);
  for (std::size_t i = 0; i < nodes.size(); i += 7) {
    for (std::size_t j = 0; j < nodes.size(); j += 5) {
      const Mat3 block = store.block(nodes[i], nodes[j]);
      const Mat3 expected = solved(*tissue, nodes[i], nodes[j]);
      // Blocks between distant nodes are small differences of large numbers: compare on the scale of the diagonal
      // blocks.
      const double scale = store.block(nodes[i], nodes[i]).norm() + store.block(nodes[j], nodes[j]).norm();
      EXPECT_LE((block - expected).norm(), 1e-12 * scale);
    }
  }
}

TEST(ComplianceStore, is_symmetric_to_the_last_bit_and_positive_definite) {
  const auto tissue = two_regions();
  ComplianceStore store(tissue);
  std::vector<Index> nodes;
  for (Index a = tissue->mesh().node_count() - 1; a > 100; a -= 9) nodes.push_back(a);
  store.add_nodes(std::span<const Index>(nodes).first(5));
  store.add_nodes(nodes);
  const auto n = static_cast<Eigen::Index>(nodes.size());
  MatX A(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) A.block<3, 3>(3 * i, 3 * j) = store.block(nodes[i], nodes[j]);
  }
  EXPECT_EQ((A - A.transpose()).norm(), 0.0);
  EXPECT_EQ(A.llt().info(), Eigen::Success);
}

TEST(ComplianceStore, nodes_in_the_middle_of_an_edge_are_stored_with_its_ends) {
  const TetMesh mesh = box_mesh({0, 0, 0}, {50, 50, 50}, {3, 3, 3}, 0.15);
  const auto fixed = test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
  const auto tissue = std::make_shared<const Tissue>(test::build(mesh, {{0.01, 0.49}}, fixed, Element::p2));
  ComplianceStore store(tissue);
  const auto& tet = mesh.tets[80];
  store.add_nodes({tet.data(), 2});
  const auto nodes = tissue->nodes_of(80);
  EXPECT_TRUE(store.has(nodes[4]));  // in the middle of the edge between the first two corners
  EXPECT_FALSE(store.has(nodes[5]));
  store.add_nodes(tet);
  for (const Index a : nodes) {
    ASSERT_TRUE(store.has(a));
    for (const Index b : nodes) {
      const double scale = store.block(a, a).norm() + store.block(b, b).norm();
      EXPECT_LE((store.block(a, b) - solved(*tissue, a, b)).norm(), 1e-12 * scale);
    }
  }
}

TEST(ComplianceStore, fixed_nodes_are_stored_and_do_not_move) {
  const auto tissue = two_regions();
  ComplianceStore store(tissue);
  const Index fixed = tissue->fixed_nodes().front();
  const Index free = tissue->mesh().node_count() - 1;
  EXPECT_TRUE(store.has(fixed));
  EXPECT_FALSE(store.has(free));
  const std::vector<Index> both{fixed, free, free};
  store.add_nodes(both);
  EXPECT_TRUE(store.has(free));
  EXPECT_EQ(store.stored_nodes(), 1);
  EXPECT_EQ(store.block(fixed, free), Mat3::Zero());
  EXPECT_EQ(store.block(free, fixed), Mat3::Zero());
  EXPECT_GT(store.block(free, free).trace(), 0.0);
  EXPECT_EQ(&store.tissue(), tissue.get());
  EXPECT_NEAR(store.megabytes(), 9 * 8.0 / 1048576.0, 1e-15);
}

TEST(ComplianceStore, reports_progress_from_zero_to_one) {
  const auto tissue = two_regions();
  ComplianceStore store(tissue);
  std::vector<Index> nodes;
  for (Index a = 100; a < 300; ++a) nodes.push_back(a);
  std::vector<double> fractions;
  store.add_nodes(nodes, [&](std::string_view, double fraction) { fractions.push_back(fraction); });
  ASSERT_GE(fractions.size(), 4u);
  EXPECT_EQ(fractions.front(), 0.0);
  EXPECT_EQ(fractions.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

}  // namespace
}  // namespace stylet
