// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the stiffness of sections with figures published for 18 gauge needles, and tests what is refused.
#include "stylet/needle/cannula.hpp"
#include "stylet/needle/section.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace stylet {
namespace {

SectionStiffness of(const Cannula& cannula) {
  const auto stiffness = section_stiffness(cannula);
  EXPECT_TRUE(stiffness.ok()) << (stiffness.ok() ? "" : stiffness.error().message());
  return stiffness.ok() ? *stiffness : SectionStiffness{};
}

TEST(Cannula, EighteenGaugeTubesOfThreeLumensAndASolidRodAreAsStiffAsPublished) {
  EXPECT_NEAR(of({.lumen_diameter_mm = 0.838}).bending_Nmm2, 20.7e3, 100.0);
  EXPECT_NEAR(of({.lumen_diameter_mm = 1.0}).bending_Nmm2, 15.7e3, 100.0);
  EXPECT_NEAR(of({.lumen_diameter_mm = 1.07}).bending_Nmm2, 12.7e3, 100.0);
  EXPECT_NEAR(of({.lumen_diameter_mm = 0.0}).bending_Nmm2, 25.5e3, 100.0);
}

TEST(Cannula, TheModelsDefaultSectionIsTheDefaultTube) {
  const SectionStiffness tube = of({});
  EXPECT_NEAR(NeedleSection{}.bending_stiffness_Nmm2, tube.bending_Nmm2, 0.5);
  EXPECT_NEAR(NeedleSection{}.torsion_stiffness_Nmm2, tube.torsion_Nmm2, 0.5);
  EXPECT_NEAR(tube.axial_N, 200e3 * 0.48137, 5.0);
}

TEST(Cannula, AStyletAddsItsOwnBendingStiffnessOnly) {
  const SectionStiffness tube = of({});
  const SectionStiffness with = of({.stylet_diameter_mm = 0.9});
  const SectionStiffness wire = of({.outer_diameter_mm = 0.9, .lumen_diameter_mm = 0.0});
  EXPECT_DOUBLE_EQ(with.bending_Nmm2, tube.bending_Nmm2 + wire.bending_Nmm2);
  EXPECT_EQ(with.torsion_Nmm2, tube.torsion_Nmm2);
  EXPECT_EQ(with.axial_N, tube.axial_N);
  // About a common axis, bending stiffnesses add up whether or not the parts are glued together: a stylet that fills
  // the lumen has the effect of a solid needle.
  EXPECT_NEAR(of({.stylet_diameter_mm = 1.0}).bending_Nmm2, of({.lumen_diameter_mm = 0.0}).bending_Nmm2, 1e-6);
  EXPECT_GT(of({.stylet_diameter_mm = 0.9, .stylet_young_MPa = 50e3}).bending_Nmm2, tube.bending_Nmm2);
}

TEST(Cannula, WhatDoesNotFitIsRefusedWithWhatWasExpected) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [cannula, says] :
       {std::pair{Cannula{.outer_diameter_mm = 0.0}, "outer diameter"},
        {Cannula{.lumen_diameter_mm = 1.27}, "less than the outer diameter, 1.27 mm"},
        {Cannula{.lumen_diameter_mm = nan}, "lumen diameter"},
        {Cannula{.stylet_diameter_mm = 1.1}, "expected 0 … 1 mm"},
        {Cannula{.young_MPa = -1.0}, "Young's modulus"},
        {Cannula{.poisson = 0.6}, "Poisson's ratio"},
        {Cannula{.stylet_diameter_mm = 0.9, .stylet_young_MPa = 0.0}, "stylet's Young"}}) {
    const auto result = section_stiffness(cannula);
    ASSERT_FALSE(result.ok()) << says;
    EXPECT_EQ(result.error().kind, ErrorKind::input);
    EXPECT_NE(result.error().message().find(says), std::string::npos) << result.error().message();
    EXPECT_FALSE(result.error().cure.empty());
  }
}

}  // namespace
}  // namespace stylet
