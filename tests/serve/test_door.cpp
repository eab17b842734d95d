// SPDX-License-Identifier: GPL-3.0-or-later
#include "door.hpp"

#include <gtest/gtest.h>

#include <vector>

using stylet::serve::Door;

TEST(Door, lets_so_many_in_and_again_when_one_has_left) {
  Door door(3, 2);
  auto first = door.enter("a");
  const auto second = door.enter("a");
  EXPECT_TRUE(first && second);
  EXPECT_FALSE(door.enter("a")) << "a third of one address";
  const auto other = door.enter("b");
  EXPECT_TRUE(other);
  EXPECT_FALSE(door.enter("c")) << "a fourth in all";
  EXPECT_EQ(door.open(), 3u);
  const auto copy = first;
  first.reset();
  EXPECT_FALSE(door.enter("a")) << "a copy of the pass is still there";
}

TEST(Door, a_pass_that_is_gone_frees_its_place_also_after_the_door) {
  auto door = std::make_unique<Door>(1, 1);
  auto pass = door->enter("a");
  pass.reset();
  EXPECT_EQ(door->open(), 0u);
  pass = door->enter("a");
  EXPECT_TRUE(pass);
  door.reset();
  pass.reset();
}
