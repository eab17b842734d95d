// SPDX-License-Identifier: GPL-3.0-or-later
// A page that holds the needle and says nothing any more.
#include "holder_watch.hpp"

#include <gtest/gtest.h>

using stylet::serve::HolderWatch;

namespace {

/// Turns until the hand is stopped, at most 100.
int turns_until_stop(HolderWatch& watch) {
  for (int k = 1; k <= 100; ++k) {
    if (watch.turn()) return k;
  }
  return 0;
}

}  // namespace

TEST(HolderWatch, stops_the_hand_of_a_silent_holder_once_and_within_a_second) {
  HolderWatch watch(0.8);
  watch.watch(7);
  for (int k = 0; k < 50; ++k) {
    watch.hear(7);
    EXPECT_FALSE(watch.turn());
  }
  watch.hear(7);
  EXPECT_EQ(turns_until_stop(watch), 8) << "of a tenth of a second";
  EXPECT_TRUE(watch.is_stopped());
  EXPECT_EQ(turns_until_stop(watch), 0) << "it is stopped already";
  watch.hear(7);
  EXPECT_TRUE(watch.is_stopped()) << "until the page knows";
  watch.go_on();
  EXPECT_FALSE(watch.is_stopped());
  EXPECT_EQ(turns_until_stop(watch), 8);
}

TEST(HolderWatch, hears_nobody_else_and_lets_the_next_holder_move) {
  HolderWatch watch(0.8);
  EXPECT_EQ(turns_until_stop(watch), 0) << "nobody holds the needle";
  watch.watch(7);
  int turns = 0;
  do {
    watch.hear(8);
    ++turns;
  } while (!watch.turn());
  EXPECT_EQ(turns, 8);
  watch.watch(7);
  EXPECT_TRUE(watch.is_stopped());
  watch.watch(8);
  EXPECT_FALSE(watch.is_stopped());
}
