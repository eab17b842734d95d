// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/structure_names.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

using Found = std::vector<std::size_t>;

TEST(StructureNames, an_equal_name_goes_before_one_that_differs_in_case) {
  const std::vector<std::string> names{"PTV", "ptv", "Rectum", "rectum "};
  EXPECT_EQ(find_named(names, "ptv"), (Found{1}));
  EXPECT_EQ(find_named(names, "PTV"), (Found{0}));
  EXPECT_EQ(find_named(names, "Ptv"), (Found{0, 1}));
  EXPECT_EQ(find_named(names, "RECTUM"), (Found{2, 3}));
  EXPECT_TRUE(find_named(names, "PTV 1").empty());
}

TEST(StructureNames, an_empty_word_means_no_structure) {
  const std::vector<std::string> names{"PTV", "", " "};
  for (const char* word : {"", " ", "\t"}) {
    EXPECT_TRUE(find_named(names, word).empty());
    EXPECT_FALSE(is_listed("", std::vector<std::string>{word}));
  }
}

TEST(StructureNames, a_number_is_a_region_without_a_name) {
  const std::vector<std::string> names{"region 1", "region -2", "prostate"};
  EXPECT_EQ(find_region(names, "1"), (Found{0}));
  EXPECT_EQ(find_region(names, "-2"), (Found{1}));
  EXPECT_EQ(find_region(names, "Prostate"), (Found{2}));
  EXPECT_EQ(find_region(std::vector<std::string>{"region 1", "1"}, "1"), (Found{1}));
  for (const char* word : {"2", "", "-", "on 1"}) EXPECT_TRUE(find_region(names, word).empty()) << word;
}

TEST(StructureNames, listed_names_differ_in_nothing_but_case) {
  const std::vector<std::string> words{"rectum", "X1"};
  EXPECT_TRUE(is_listed("Rectum", words));
  EXPECT_TRUE(is_listed("x1", words));
  EXPECT_FALSE(is_listed("Rectum 2", words));
  EXPECT_FALSE(is_listed("", words));
}

TEST(StructureNames, the_advice_to_leave_a_structure_out_says_its_name) {
  EXPECT_NE(or_skip("Rectum").find("skip = [\"Rectum\"] below [patient]"), std::string::npos);
}

}  // namespace
}  // namespace stylet
