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

TEST(NearestName, finds_a_name_by_one_of_its_words) {
  const std::vector<std::string> known{"retract_speed_mm_per_s",  "speed_mm_per_s", "depth_mm", "young_kPa", "bow_mm",
                                       "friction_static_N_per_m", "dwell_s"};
  EXPECT_EQ(nearest_name("speed", known), "speed_mm_per_s") << "the shortest of those with the word";
  EXPECT_EQ(nearest_name("retract_speed", known), "retract_speed_mm_per_s");
  EXPECT_EQ(nearest_name("depth", known), "depth_mm");
  EXPECT_EQ(nearest_name("young_modulus", known), "young_kPa");
  EXPECT_EQ(nearest_name("frction", known), "friction_static_N_per_m") << "a word with a typing error";
  EXPECT_EQ(nearest_name("bow", known), "bow_mm");
  EXPECT_EQ(nearest_name("time_s", known), "") << "units are no words";
}

TEST(NearestName, suggests_nothing_when_nothing_is_near) {
  const std::vector<std::string> known{"young_kPa", "poisson"};
  EXPECT_EQ(nearest_name("temperature", known), "");
  EXPECT_EQ(nearest_name("x", {}), "");
}
