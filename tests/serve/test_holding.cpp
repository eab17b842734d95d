// SPDX-License-Identifier: GPL-3.0-or-later
#include "holding.hpp"

#include <gtest/gtest.h>

using stylet::serve::Holding;

TEST(Holding, the_first_to_take_the_needle_has_it) {
  Holding holding;
  EXPECT_EQ(holding.holder(), 0u);
  holding.take(7);
  EXPECT_EQ(holding.holder(), 7u);
  holding.take(7);
  EXPECT_EQ(holding.asking(), 0u);
}

TEST(Holding, goes_to_who_has_asked_longest_and_once_only) {
  Holding holding;
  holding.take(1);
  holding.take(2);
  holding.take(3);
  holding.take(2);  // asking again does not change the order
  EXPECT_EQ(holding.asking(), 2u);
  EXPECT_EQ(holding.holder(), 1u);
  holding.release(1);
  EXPECT_EQ(holding.holder(), 2u);
  EXPECT_FALSE(holding.asks(2));
  EXPECT_TRUE(holding.asks(3));
  holding.release(2);
  EXPECT_EQ(holding.holder(), 3u);
  holding.release(3);
  EXPECT_EQ(holding.holder(), 0u);
}

TEST(Holding, who_leaves_neither_keeps_the_needle_nor_a_place) {
  Holding holding;
  holding.take(1);
  holding.take(2);
  holding.take(3);
  EXPECT_FALSE(holding.leave(2));
  EXPECT_TRUE(holding.leave(1));
  EXPECT_EQ(holding.holder(), 3u);
  EXPECT_EQ(holding.asking(), 0u);
}

TEST(Holding, releasing_withdraws_a_wish) {
  Holding holding;
  holding.take(1);
  holding.take(2);
  holding.release(2);
  holding.release(1);
  EXPECT_EQ(holding.holder(), 0u);
}
