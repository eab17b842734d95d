// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/make_needle.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace stylet {
namespace {

struct Refused {
  const char* name;
  NeedleSection section;
  int elements;
  int capacity;
  const char* says;
};

class NeedleBuild : public testing::TestWithParam<Refused> {};

TEST_P(NeedleBuild, refuses_nonsense_saying_what_was_expected) {
  const Refused& bad = GetParam();
  for (const std::string& model : needle_models()) {
    const auto result = make_needle(model, bad.section, bad.elements, bad.capacity);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().kind, ErrorKind::input);
    EXPECT_NE(result.error().message().find(bad.says), std::string::npos) << result.error().message();
    EXPECT_FALSE(result.error().cure.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, NeedleBuild,
    testing::Values(Refused{"length", {.length_mm = 0.0}, 24, 10, "length"},
                    Refused{"diameter", {.outer_diameter_mm = -1.27}, 24, 10, "diameter"},
                    Refused{"bending", {.bending_stiffness_Nmm2 = 0.0}, 24, 10, "bending stiffness"},
                    Refused{"nan", {.bending_stiffness_Nmm2 = std::numeric_limits<double>::quiet_NaN()}, 24, 10, "nan"},
                    Refused{"torsion", {.torsion_stiffness_Nmm2 = -1.0}, 24, 10, "torsion stiffness"},
                    Refused{"stiffer_than_solid", {.bending_stiffness_Nmm2 = 30000.0}, 24, 10, "26817 N mm²"},
                    Refused{"bow", {.bow_mm = -1.0}, 24, 10, "expected 0 … 20 mm"},
                    Refused{"bow_direction", {.bow_deg = std::numeric_limits<double>::infinity()}, 24, 10, "degrees"},
                    Refused{"elements", {}, 3, 10, "4…500"}, Refused{"capacity", {}, 24, 0, "at least 1"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(MakeNeedle, accepts_the_stiffest_solid_needle) {
  for (const std::string& model : needle_models())
    EXPECT_TRUE(make_needle(model, {.bending_stiffness_Nmm2 = 26800.0}, 0, 10).ok());
}

TEST(MakeNeedle, an_unknown_model_is_refused_with_the_nearest_name) {
  const auto result = make_needle("spring", {}, 0, 10);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message().find("Did you mean 'springs'?"), std::string::npos) << result.error().message();
}

}  // namespace
}  // namespace stylet
