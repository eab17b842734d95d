// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/validate/sensitivity.hpp"
#include "stylet/evidence/validate/validation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace stylet;
using namespace stylet::validate;

namespace {

Sensitivity made_up() {
  Sensitivity study;
  study.scenario = "a needle";
  study.base = {2.0, 0.5, 1.0};
  study.influences.push_back({"a.weak", "weak", "N", "1", "0.8", "1.2", {1.98, 0.5, 1.0}, {2.02, 0.5, 1.0}, ""});
  study.influences.push_back(
      {"a.strong", "strong", "N", "1", "0.8", "1.2", {1.0, 0.6, 1.0}, {3.0, 0.4, 1.0}, "a note"});
  study.influences.push_back({"a.choice", "other", "", "one", "two", "", {9.0, 0.5, 1.0}, {}, ""});
  return study;
}

}  // namespace

TEST(Sensitivity, lines_put_the_most_influential_parameter_first_and_choices_last) {
  const auto lines = sensitivity_lines(made_up());
  ASSERT_EQ(lines.size(), 4u);
  for (const auto& line : lines) EXPECT_EQ(line.size(), lines.front().size());
  EXPECT_EQ(lines[1][0], "a.strong");
  EXPECT_EQ(lines[1][4], "−50 %");
  EXPECT_EQ(lines[1][5], "+50 %");
  EXPECT_EQ(lines[2][0], "a.weak");
  EXPECT_EQ(lines[2][4], "−1.0 %");
  EXPECT_EQ(lines[2][6], "0 %");
  EXPECT_EQ(lines[3][0], "a.choice");
}

TEST(Sensitivity, is_a_section_of_the_page) {
  Validation validation;
  validation.sensitivity = made_up();
  const auto page = validation_page(validation);
  ASSERT_TRUE(page.ok()) << page.error().message();
  const auto strong = page->find("<code>a.strong</code>");
  ASSERT_NE(strong, std::string::npos);
  EXPECT_LT(strong, page->find("<code>a.weak</code>"));
  EXPECT_NE(page->find("+50 %"), std::string::npos);
  EXPECT_NE(page->find("a note"), std::string::npos);
}

TEST(Sensitivity, a_stiffer_gland_moves_less) {
  const auto study = measure_sensitivity(true);
  ASSERT_TRUE(study.ok()) << study.error().message();
  EXPECT_GT(study->base.peak_axial_N, 0.1);
  EXPECT_GT(study->base.target_shift_mm, 0.0);
  const auto gland = std::find_if(study->influences.begin(), study->influences.end(),
                                  [](const Influence& i) { return i.key == "tissue.prostate.young_kPa"; });
  ASSERT_NE(gland, study->influences.end());
  EXPECT_EQ(gland->low, "48");
  EXPECT_EQ(gland->high, "72");
  EXPECT_GT(gland->at_low.target_shift_mm, gland->at_high.target_shift_mm);
  EXPECT_TRUE(std::any_of(study->influences.begin(), study->influences.end(),
                          [](const Influence& i) { return i.key.starts_with("needle."); }));
  for (const Influence& i : study->influences) EXPECT_TRUE(i.note.empty() || i.note.starts_with("limited")) << i.note;
}
