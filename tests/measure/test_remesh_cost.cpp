// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/hat_stiffness.hpp"
#include "measure/needle_way.hpp"
#include "stylet/coupling/paper/inverse_updates.hpp"
#include "stylet/measure/remesh_bench.hpp"
#include "stylet/measure/timing.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace stylet;
using namespace stylet::measure;

namespace {

const Block& small_block() {
  static const auto block = Block::build(4);
  EXPECT_TRUE(block.ok());
  return **block;
}

}  // namespace

TEST(RemeshCost, all_methods_agree_on_the_same_nodes_by_both_rules) {
  for (const Placement placement : {Placement::face, Placement::interior}) {
    RemeshCostOptions options{.placement = placement, .rounds = 2, .bcs_rounds = 1, .inverse_rounds = 1};
    const auto cost = test::value_of(measure_remeshing(small_block().way(), options));
    EXPECT_EQ(cost.nodes, 125);
    EXPECT_EQ(cost.dofs, 300);
    EXPECT_EQ(cost.change, placement == Placement::face ? 18 : 15);
    EXPECT_GE(cost.events, 3);
    EXPECT_LT(cost.largest_error, 1e-11);
    EXPECT_LT(cost.ours.median_s, cost.woodbury.median_s);
    EXPECT_LT(cost.woodbury.median_s, cost.bcs.median_s);
    EXPECT_LE(cost.ours.median_s, cost.ours.largest_s);
    for (const auto& times :
         {cost.ours_cold, cost.woodbury_full, cost.inverse, cost.rank_update, cost.stiffness, cost.hat})
      EXPECT_GT(times.median_s, 0.0);
  }
}

TEST(RemeshCost, a_way_beside_the_tissue_is_refused) {
  NeedleWay way = small_block().way();
  way.from = {-50, -50, -50};
  way.to = {-50, -50, 50};
  const auto cost = measure_remeshing(way, {});
  ASSERT_FALSE(cost.ok());
  EXPECT_NE(cost.error().message().find("no node can be added"), std::string::npos);
}

TEST(RemeshCost, stiffness_of_a_node_inside_an_element_is_that_of_its_hat) {
  const NeedleWay& way = small_block().way();
  const auto nodes = nodes_along(way, {.placement = Placement::interior, .most_nodes = 4});
  ASSERT_EQ(nodes.size(), 4u);
  const Tissue& tissue = way.store->tissue();
  for (const AddedNode& node : nodes) {
    const MatX change = stiffness_change(tissue, node);
    ASSERT_EQ(node.change.before.size(), 1u);
    const auto& element = node.change.before.front();
    const Mat3 hat = hat_stiffness(element.gradients, element.volume, tissue.material(0), element.weights(node.x));
    EXPECT_LT((change.bottomRightCorner<3, 3>() - hat).norm(), 1e-12 * hat.norm());
  }
}

TEST(RemeshCost, counted_multiplications_are_those_the_paper_states) {
  // The paper states 2 (3m) (3n)² and 3m (3n)² + (3m)² 3n + 2 (3m)³; the counts agree to leading order.
  for (const auto& [N, k] : {std::pair{300, 18}, std::pair{600, 18}, std::pair{600, 36}}) {
    const CountedCost counted = count_operations(N, k);
    EXPECT_NEAR(counted.switches / paper::cost_of_switches(N, k), 1.0, 2.0 / N) << N << ' ' << k;
    EXPECT_NEAR(counted.woodbury / paper::cost_of_woodbury(N, k), 1.0, 1.5 * k / N) << N << ' ' << k;
  }
}

TEST(RemeshCost, switches_take_new_degrees_of_freedom_one_way_only) {
  const int N = 200;
  const int k = 12;
  const CountedCost all_old = count_operations(N, k);
  const CountedCost three_new = count_operations(N, k, 3);
  EXPECT_NEAR(three_new.switches / all_old.switches, (2.0 * k - 3) / (2.0 * k), 1e-12);
  EXPECT_EQ(three_new.woodbury, all_old.woodbury);
}

TEST(RemeshBench, every_method_is_measured_at_every_size) {
  const auto rows = test::value_of(bench_remeshing({3, 4}));
  ASSERT_EQ(rows.size(), 10u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].nodes, i < 5 ? 64 : 125);
    EXPECT_GT(rows[i].median_us, 0.0);
  }
  EXPECT_EQ(rows[0].method, "shortcut");
  EXPECT_EQ(rows[4].method, "inverse");
}

TEST(Measure, median_is_the_middle_of_the_sorted_values) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_TRUE(std::isnan(median({})));
}
