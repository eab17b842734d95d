// SPDX-License-Identifier: GPL-3.0-or-later
// The borders of splits, and their loads on base nodes.
#include "coupling/track/split_borders.hpp"

#include <gtest/gtest.h>

using namespace stylet;

namespace {

Mat3 times(double factor) { return factor * Mat3::Identity(); }

}  // namespace

TEST(SplitBorders, a_split_begins_without_a_border) {
  SplitBorders borders(2);
  borders.begin();
  EXPECT_EQ(borders.count(), 1);
  EXPECT_TRUE(borders.border(0).empty());
  EXPECT_TRUE(borders.loads(0).nodes.empty());
}

TEST(SplitBorders, a_vertex_of_two_elements_is_on_the_border_once_with_the_sum_of_both) {
  SplitBorders borders(2);
  borders.begin();
  borders.add(12, times(1.0));
  borders.add(15, times(2.0));
  borders.add(12, times(4.0));
  const auto border = borders.border(0);
  ASSERT_EQ(border.size(), 2u);
  EXPECT_EQ(border[0].vertex, 12);
  EXPECT_EQ(border[0].k, times(5.0));
  EXPECT_EQ(border[1].vertex, 15);
  EXPECT_EQ(border[1].k, times(2.0));
}

TEST(SplitBorders, a_load_is_distributed_by_the_weights_and_each_node_is_loaded_once) {
  SplitBorders borders(2);
  borders.begin();
  borders.add_loads({.count = 3, .node = {4, 6, 8}, .weight = {0.25, 0.75, 0.0}}, times(4.0));
  borders.add_loads({.count = 1, .node = {6}, .weight = {1.0}}, times(2.0));
  const NodeLoads loads = borders.loads(0);
  ASSERT_EQ(loads.nodes.size(), 2u) << "a node of weight 0 has none";
  ASSERT_EQ(loads.blocks.size(), 2u);
  EXPECT_EQ(loads.nodes[0], 4);
  EXPECT_EQ(loads.blocks[0], times(1.0));
  EXPECT_EQ(loads.nodes[1], 6);
  EXPECT_EQ(loads.blocks[1], times(5.0));
}

TEST(SplitBorders, splits_do_not_mix_and_reset_forgets_them) {
  SplitBorders borders(3);
  for (int round = 0; round < 2; ++round) {
    for (int split = 0; split < 3; ++split) {
      borders.begin();
      if (split == 1) continue;  // inside an element
      borders.add(7, times(split + 1.0));
      borders.add_loads({.count = 1, .node = {3}, .weight = {1.0}}, times(split + 1.0));
    }
    for (const int split : {0, 2}) {
      ASSERT_EQ(borders.border(split).size(), 1u);
      EXPECT_EQ(borders.border(split)[0].k, times(split + 1.0));
      EXPECT_EQ(borders.loads(split).blocks[0], times(split + 1.0));
    }
    EXPECT_TRUE(borders.border(1).empty());
    borders.reset();
    EXPECT_EQ(borders.count(), 0);
  }
}
