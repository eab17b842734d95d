// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/near_field/medium_block.hpp"

#include "support/count_allocations.hpp"
#include "support/sanitized.hpp"

namespace stylet {
namespace {

using test::MediumBlock;

TEST(NearField, compliance_of_a_moving_tip_changes_without_jumps) {
  MediumBlock block({.cells = 8});
  const NeedleKernel needle;
  std::vector<Vec3> way;
  for (double z = -15.0; z < 15.0; z += 0.05) way.emplace_back(0.9 + 0.11 * z, -2.3 + 0.07 * z, z);
  block.prepare(way);
  NearFieldCompliance compliance = block.compliance(needle, 4);
  const Vec3 held = way.front();
  ASSERT_EQ(compliance.add(block.at(held), held, Placement::embedded, Vec3::UnitZ()).point, 1);
  Mat3 own = Mat3::Zero();
  Mat3 across = Mat3::Zero();
  for (std::size_t k = 0; k < way.size(); ++k) {
    ASSERT_TRUE(compliance.move_tip(block.at(way[k]), way[k]));
    const double scale = compliance(0, 0).trace() / 3.0;
    if (k > 0) {
      EXPECT_LT((compliance(0, 0) - own).norm(), 1e-3 * scale) << way[k].transpose();
      EXPECT_LT((compliance(0, 1) - across).norm(), 0.05 * scale) << way[k].transpose();
    }
    own = compliance(0, 0);
    across = compliance(0, 1);
  }
}

TEST(NearField, hardly_depends_on_where_in_an_element_the_tip_is) {
  MediumBlock block({.cells = 8});
  const NeedleKernel needle;
  double least = 1e9;
  double most = 0.0;
  for (int k = 0; k < 40; ++k) {
    const Vec3 x(0.31 * k - 6.0, std::fmod(1.7 * k, 12.0) - 6.0, std::fmod(2.9 * k, 12.0) - 6.0);
    const double own = block.tip(needle, x).trace();
    least = std::min(least, own);
    most = std::max(most, own);
  }
  EXPECT_LT(most / least, 1.01);
}

TEST(NearField, across_an_interface_a_coarse_mesh_agrees_with_a_fine_one) {
  if (test::kSanitized) GTEST_SKIP() << test::kTooLongSanitized;
  for (const double ratio : {3.0, 10.0}) {
    const auto force = [&](int cells, bool lateral) {
      MediumBlock block({.cells = cells,
                         .regions = {"soft", "hard"},
                         .region_at = [](const Vec3& x) { return x.z() < 0.0 ? 0 : 1; },
                         .materials = {{0.01, 0.45}, {0.01 * ratio, 0.45}}});
      const test::NeedleLine line(block, 4.0, {0, 0, 1}, false);
      return lateral ? line.lateral() : line.axial();
    };
    EXPECT_NEAR(force(8, true) / force(20, true), 1.0, 0.05) << ratio;
    EXPECT_NEAR(force(8, false) / force(20, false), 1.0, 0.06) << ratio;
  }
}

TEST(NearField, displacement_of_a_held_node_is_what_its_compliance_says) {
  MediumBlock block({.cells = 8});
  Index node = 0;
  for (Index k = 0; k < block.tissue->mesh().node_count(); ++k) {
    const auto& nodes = block.tissue->mesh().nodes;
    if (nodes[static_cast<std::size_t>(k)].norm() < nodes[static_cast<std::size_t>(node)].norm()) node = k;
  }
  const Vec3 x = block.tissue->mesh().nodes[static_cast<std::size_t>(node)];
  block.prepare({x});
  NearFieldCompliance compliance = block.compliance({}, 2);
  ASSERT_TRUE(compliance.move_tip(block.at(x), x));
  MatX force = MatX::Zero(3, 1);
  force.col(0) = Vec3(0.1, -0.2, 0.3);
  const VecX u = compliance.displacement(force);
  EXPECT_LT((u.segment<3>(3 * Eigen::Index{node}) - compliance(0, 0) * force.col(0)).norm(),
            1e-9 * u.segment<3>(3 * Eigen::Index{node}).norm());
}

TEST(NearField, forces_on_the_mesh_balance_its_supports) {
  MediumBlock block({.cells = 6});
  const Vec3 x(1, 2, 3);
  block.prepare({x});
  NearFieldCompliance compliance = block.compliance({}, 2);
  ASSERT_TRUE(compliance.move_tip(block.at(x), x));
  MatX force = MatX::Zero(3, 1);
  force.col(0) = Vec3(0.1, -0.2, 0.3);
  const auto nodes = compliance.nodes(force);
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index k = 0; k < nodes.load.size(); k += 3) sum += nodes.support.segment<3>(k);
  EXPECT_LT((sum + force.col(0)).norm(), 1e-10);
}

TEST(NearField, is_symmetric_and_forgets_everything_on_reset) {
  MediumBlock block({.cells = 8});
  const std::vector<Vec3> points{{0, 0, -8}, {0.2, 0.1, -4}, {0.3, 0, 0}, {0.2, -0.1, 4}};
  block.prepare(points);
  NearFieldCompliance compliance = block.compliance({}, 4);
  const auto lay = [&] {
    for (const Vec3& x : points) EXPECT_GT(compliance.add(block.at(x), x, Placement::interior, Vec3::UnitZ()).point, 0);
    EXPECT_TRUE(compliance.move_tip(block.at(points[3]), points[3]));
    return MatX(compliance.matrix().topLeftCorner(15, 15));
  };
  const MatX first = lay();
  EXPECT_EQ(first, first.transpose());
  EXPECT_TRUE(compliance.remeshing().empty());
  compliance.reset();
  EXPECT_EQ(compliance.points(), 1);
  EXPECT_EQ(lay(), first);
}

TEST(NearField, needs_the_elements_compliance_and_kernel) {
  MediumBlock block({.cells = 6});
  const Vec3 x(1, 2, 3);
  NearFieldCompliance compliance = block.compliance({}, 2);
  EXPECT_FALSE(compliance.move_tip(block.at(x), x));
  EXPECT_EQ(compliance.add(block.at(x), x, Placement::embedded).refusal, ContactCompliance::Refusal::missing);
  block.store->add_nodes(block.tissue->nodes_of(block.at(x).tet));
  EXPECT_FALSE(compliance.available(block.at(x).tet));
  block.kernel->add_nodes(block.tissue->nodes_of(block.at(x).tet));
  EXPECT_TRUE(compliance.move_tip(block.at(x), x));
}

TEST(NearField, allocates_nothing_while_the_tip_moves_and_contacts_come) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "the memory functions cannot be replaced under sanitizers";
  MediumBlock block({.cells = 8, .skin = true});
  std::vector<Vec3> way;
  for (double z = -50.0; z < -20.0; z += 0.5) way.emplace_back(0.9, -2.3, z);
  block.prepare(way);
  std::vector<MaterialPoint> at;
  for (const Vec3& x : way) at.push_back(block.at(x));
  NearFieldCompliance compliance = block.compliance({}, 40);
  const test::AllocationCount count;
  for (std::size_t k = 0; k < way.size(); ++k) {
    compliance.move_tip(at[k], way[k]);
    if (k % 8 == 4) compliance.add(at[k], way[k], Placement::embedded, Vec3::UnitZ());
  }
  compliance.reset();
  EXPECT_EQ(count.count(), 0);
}

}  // namespace
}  // namespace stylet
