// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the compliance of a corridor that is computed from the trailing block of the factor.
#include "bodies.hpp"

#include "stylet/fem/compliance_store.hpp"

#include <thread>

namespace stylet {
namespace {

TetMesh mesh_of(int cells) {
  TetMesh mesh = box_mesh({0, 0, 0}, {50, 50, 50}, {cells, cells, cells}, 0.15);
  assign_regions(mesh, {"fat", "gland"}, [](const Vec3& x) { return x.x() > 25 ? 0 : 1; });
  return mesh;
}

const std::vector<Material> kMaterials{{0.01, 0.49}, {0.05, 0.4}};

std::vector<Index> floor_of(const TetMesh& mesh) {
  return test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
}

/// A tissue whose corridor is eliminated last.
Tissue with_corridor(const TetMesh& mesh, Element element, const std::vector<Index>& corridor) {
  auto tissue = Tissue::build(mesh, kMaterials, floor_of(mesh), {}, element, corridor);
  if (!tissue) throw std::runtime_error(tissue.error().message());
  return std::move(*tissue);
}

/// Largest difference between the corridor's blocks and solves with the factor of a tissue without a corridor, relative
/// to the diagonal blocks.
double difference(const TetMesh& mesh, Element element, const std::vector<Index>& corridor) {
  const Tissue tissue = with_corridor(mesh, element, corridor);
  const Tissue plain = with_corridor(mesh, element, {});
  const MatX blocks = tissue.compliance_of_corridor();
  const std::vector<Index>& nodes = tissue.corridor();
  EXPECT_EQ(blocks.rows(), static_cast<Eigen::Index>(3 * nodes.size()));
  EXPECT_EQ((blocks - blocks.transpose()).norm(), 0.0);
  double worst = 0.0;
  for (std::size_t j = 0; j < nodes.size(); j += 1 + nodes.size() / 7) {
    MatX f = MatX::Zero(3 * Eigen::Index{plain.displacement_nodes()}, 3);
    f.middleRows<3>(3 * Eigen::Index{nodes[j]}).setIdentity();
    const MatX u = plain.solve(f);
    EXPECT_LE((tissue.solve(f) - u).norm(), 1e-11 * u.norm());  // any other compliance still comes from solves
    const auto block = [&](std::size_t i, std::size_t k) {
      return blocks.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * k));
    };
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double scale = block(i, i).norm() + block(j, j).norm();
      worst = std::max(worst, (block(i, j) - u.middleRows<3>(3 * Eigen::Index{nodes[i]})).norm() / scale);
    }
  }
  return worst;
}

class CorridorCompliance : public test::ElementTest {};
STYLET_FOR_EVERY_ELEMENT(CorridorCompliance);

TEST_P(CorridorCompliance, is_that_of_solves_around_a_line) {
  const TetMesh mesh = mesh_of(5);
  const auto near = test::nodes_where(mesh, [](const Vec3& x) { return (x - Vec3(25, 25, 25)).head<2>().norm() < 12; });
  ASSERT_TRUE(
      std::any_of(near.begin(), near.end(), [&](Index a) { return mesh.nodes[a].z() == 0.0; }));  // some are held
  EXPECT_LE(difference(mesh, GetParam(), near), 1e-12);
}

TEST_P(CorridorCompliance, is_that_of_solves_in_two_pieces_in_any_order) {
  const TetMesh mesh = mesh_of(5);
  auto near = test::nodes_where(mesh, [](const Vec3& x) { return x.x() < 12 || x.x() > 38; });
  std::reverse(near.begin(), near.end());
  near.push_back(near.front());
  EXPECT_LE(difference(mesh, GetParam(), near), 1e-12);
}

TEST_P(CorridorCompliance, is_the_whole_inverse_where_the_corridor_is_the_mesh) {
  const TetMesh mesh = mesh_of(3);
  const auto all = test::nodes_where(mesh, [](const Vec3&) { return true; });
  EXPECT_LE(difference(mesh, GetParam(), all), 1e-12);
  const Tissue tissue = with_corridor(mesh, GetParam(), all);
  ASSERT_EQ(static_cast<Index>(3 * tissue.corridor().size()), tissue.free_dofs());
  const MatX unit = tissue.compliance_of_corridor() * MatX(tissue.stiffness());
  EXPECT_LE((unit - MatX::Identity(unit.rows(), unit.cols())).norm(), 1e-9);
}

TEST_P(CorridorCompliance, is_empty_without_a_corridor_and_where_it_is_held) {
  const TetMesh mesh = mesh_of(3);
  for (const auto& corridor : {std::vector<Index>{}, floor_of(mesh)}) {
    const Tissue tissue = with_corridor(mesh, GetParam(), corridor);
    EXPECT_TRUE(tissue.corridor().empty());
    EXPECT_EQ(tissue.compliance_of_corridor().size(), 0);
    EXPECT_EQ(ComplianceStore(std::make_shared<const Tissue>(with_corridor(mesh, GetParam(), corridor)),
                              tissue.compliance_of_corridor())
                  .stored_nodes(),
              0);
  }
}

TEST_P(CorridorCompliance, grows_in_the_store_by_other_nodes) {
  const TetMesh mesh = mesh_of(4);
  const auto near = test::nodes_where(mesh, [](const Vec3& x) { return x.x() < 15; });
  const auto more = test::nodes_where(mesh, [](const Vec3& x) { return x.x() > 10 && x.y() < 30; });
  const auto tissue = std::make_shared<const Tissue>(with_corridor(mesh, GetParam(), near));
  ComplianceStore store(tissue, tissue->compliance_of_corridor());
  for (const Index a : near) EXPECT_TRUE(store.has(a));
  store.add_nodes(more);
  ComplianceStore solved(std::make_shared<const Tissue>(with_corridor(mesh, GetParam(), {})));
  solved.add_nodes(near);
  solved.add_nodes(more);
  for (const Index a : store.stored()) {
    ASSERT_TRUE(solved.has(a));
    for (const Index b : store.stored()) {
      const double scale = store.block(a, a).norm() + store.block(b, b).norm();
      EXPECT_LE((store.block(a, b) - solved.block(a, b)).norm(), 1e-12 * scale);
      EXPECT_EQ(store.block(a, b), Mat3(store.block(b, a).transpose()));
    }
  }
}

TEST(TissueLater, makes_its_factor_once_when_asked_by_whichever_thread) {
  const TetMesh mesh = mesh_of(4);
  const auto near = test::nodes_where(mesh, [](const Vec3& x) { return x.x() < 15; });
  auto later = Tissue::build_later(mesh, kMaterials, floor_of(mesh), Element::p1, near);
  ASSERT_TRUE(later);
  const Tissue now = with_corridor(mesh, Element::p1, near);
  EXPECT_FALSE(later->has_factor());
  EXPECT_TRUE(now.has_factor());
  EXPECT_EQ(later->corridor(), now.corridor());
  EXPECT_FALSE(later->has_factor());
  const VecX f = VecX::LinSpaced(3 * Eigen::Index{now.displacement_nodes()}, -1.0, 1.0);
  const MatX expected = now.solve(f);
  std::vector<MatX> u(3);
  {
    std::vector<std::jthread> threads;
    for (MatX& one : u) threads.emplace_back([&] { one = later->solve(f); });
  }
  EXPECT_TRUE(later->has_factor());
  for (const MatX& one : u) EXPECT_EQ(one, expected);
  EXPECT_EQ(later->compliance_of_corridor(), now.compliance_of_corridor());
}

}  // namespace
}  // namespace stylet
