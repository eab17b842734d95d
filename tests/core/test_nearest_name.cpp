// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/nearest_name.hpp"

#include <gtest/gtest.h>

#include <vector>

using namespace stylet;

TEST(NearestName, distance_counts_insertions_deletions_substitutions_and_swaps) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("nodes", ""), 5);
  EXPECT_EQ(edit_distance("node", "nodes"), 1);
  EXPECT_EQ(edit_distance("noodes", "nodes"), 1);
  EXPECT_EQ(edit_distance("nodas", "nodes"), 1);
  EXPECT_EQ(edit_distance("noeds", "nodes"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(NearestName, distance_is_symmetric_and_blind_to_case) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), edit_distance("sitting", "kitten"));
  EXPECT_EQ(edit_distance("Young_KPA", "young_kPa"), 0);
}

TEST(NearestName, finds_the_name_that_was_meant) {
  const std::vector<std::string> known{"young_kPa", "poisson", "cutting_N", "puncture_N"};
  EXPECT_EQ(nearest_name("poison", known), "poisson");
  EXPECT_EQ(nearest_name("young_kpa", known), "young_kPa");
  EXPECT_EQ(nearest_name("cuting_N", known), "cutting_N");
}

TEST(NearestName, suggests_nothing_when_nothing_is_near) {
  const std::vector<std::string> known{"young_kPa", "poisson"};
  EXPECT_EQ(nearest_name("temperature", known), "");
  EXPECT_EQ(nearest_name("x", {}), "");
}
