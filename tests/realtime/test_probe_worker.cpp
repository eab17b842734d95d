// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/probe_worker.hpp"

#include "probe/pressed_block.hpp"
#include "support/count_allocations.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace stylet {
namespace {

std::shared_ptr<const WallCompliance> small_wall() {
  static const auto wall = testing::soft_block(6).wall(testing::reach_of(testing::lying_on(0.0), 4.0));
  return wall;
}

/// Waits for the answer to a pose.
void wait_for(ProbeWorker& worker, std::uint32_t pose) {
  while (worker.answer().pose != pose) {
    if (!worker.fetch()) std::this_thread::yield();
  }
}

TEST(ProbeWorker, answers_the_newest_pose_with_the_field_of_that_pose) {
  ProbeWorker worker{ProbeContact(small_wall())};
  ProbeContact direct(small_wall());
  Eigen::Matrix3Xf u(3, small_wall()->nodes.rows() / 3);
  std::uint32_t last = 0;
  for (const double depth : {1.0, 1.5, 2.0, 3.0, 4.0}) last = worker.move(testing::lying_on(depth));
  wait_for(worker, last);
  const ProbePress press = direct.press(testing::lying_on(4.0));
  direct.displacement(u);
  EXPECT_LT((worker.answer().press.force_N - press.force_N).norm(), 0.01 * press.force_N.norm());
  EXPECT_LT((worker.displacement() - u).cwiseAbs().maxCoeff(), 0.02F);
  EXPECT_GT(worker.displacement().cwiseAbs().maxCoeff(), 1.0F);
}

TEST(ProbeWorker, field_that_was_fetched_stays_while_the_probe_moves_on) {
  ProbeWorker worker{ProbeContact(small_wall())};
  wait_for(worker, worker.move(testing::lying_on(2.0)));
  const Eigen::Matrix3Xf before = worker.displacement();
  for (int k = 0; k < 50; ++k) worker.move(testing::lying_on(2.0 + 0.05 * k));
  EXPECT_EQ((worker.displacement() - before).cwiseAbs().maxCoeff(), 0.0F);
  wait_for(worker, worker.move(testing::lying_on(5.0)));
  EXPECT_GT((worker.displacement() - before).cwiseAbs().maxCoeff(), 1.0F);
}

TEST(ProbeWorker, gives_only_the_nodes_asked_for) {
  const std::vector<Index> nodes{5, 190, 17};
  ProbeWorker worker{ProbeContact(small_wall()), nodes};
  wait_for(worker, worker.move(testing::lying_on(3.0)));
  ProbeContact direct(small_wall());
  direct.press(testing::lying_on(3.0));
  Eigen::Matrix3Xf u(3, 3);
  direct.displacement(nodes, u);
  ASSERT_EQ(worker.displacement().cols(), 3);
  EXPECT_LT((worker.displacement() - u).cwiseAbs().maxCoeff(), 1e-5F);
}

TEST(ProbeWorker, refuses_a_node_that_the_mesh_does_not_have) {
  const auto beyond = static_cast<Index>(small_wall()->nodes.rows() / 3);
  for (const Index node : {-1, beyond})
    EXPECT_THROW(ProbeWorker(ProbeContact(small_wall()), {0, node}), std::out_of_range) << node;
}

TEST(ProbeWorker, moving_and_fetching_do_not_allocate) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "allocations cannot be counted here";
  ProbeWorker worker{ProbeContact(small_wall())};
  const test::AllocationCount allocations;
  wait_for(worker, worker.move(testing::lying_on(2.0)));
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace stylet
