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

TEST(Cannula, eighteen_gauge_tubes_of_three_lumens_and_a_solid_rod_are_as_stiff_as_published) {
  EXPECT_NEAR(of({.lumen_diameter_mm = 0.838}).bending_Nmm2, 20.7e3, 100.0);
  EXPECT_NEAR(of({.lumen_diameter_mm = 1.0}).bending_Nmm2, 15.7e3, 100.0);
  EXPECT_NEAR(of({.lumen_diameter_mm = 1.07}).bending_Nmm2, 12.7e3, 100.0);
  EXPECT_NEAR(of({.lumen_diameter_mm = 0.0}).bending_Nmm2, 25.5e3, 100.0);
}

TEST(Cannula, the_models_default_section_is_the_default_tube) {
  const SectionStiffness tube = of({});
  EXPECT_NEAR(NeedleSection{}.bending_stiffness_Nmm2, tube.bending_Nmm2, 0.5);
  EXPECT_NEAR(NeedleSection{}.torsion_stiffness_Nmm2, tube.torsion_Nmm2, 0.5);
  EXPECT_NEAR(tube.axial_N, 200e3 * 0.48137, 5.0);
}

TEST(Cannula, a_stylet_adds_its_own_bending_stiffness_only) {
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

TEST(Cannula, what_does_not_fit_is_refused_with_what_was_expected) {
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
