// SPDX-License-Identifier: GPL-3.0-or-later
// Attenuation of materials against the published tables, in cm⁻¹.
#include "stylet/imaging/xray_materials.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stylet {
namespace {

double per_cm(XrayMaterial material, double energy_keV) { return 10.0 * attenuation_per_mm(material, energy_keV); }

TEST(XrayMaterials, attenuation_is_that_of_the_tables) {
  EXPECT_NEAR(per_cm(XrayMaterial::water, 50.0), 0.2269, 1e-9);
  EXPECT_NEAR(per_cm(XrayMaterial::water, 80.0), 0.1837, 1e-9);
  EXPECT_NEAR(per_cm(XrayMaterial::cortical_bone, 50.0), 0.4242 * 1.92, 1e-9);
  EXPECT_NEAR(per_cm(XrayMaterial::cortical_bone, 80.0), 0.2229 * 1.92, 1e-9);
  EXPECT_NEAR(per_cm(XrayMaterial::titanium, 80.0), 0.4052 * 4.54, 1e-9);
  EXPECT_NEAR(per_cm(XrayMaterial::iron, 60.0), 1.205 * 7.874, 1e-9);
}

/// Without coherent scattering, water and titanium have 0.21 and 5.1 cm⁻¹ at 50 keV, 0.18 and 1.65 cm⁻¹ at 80 keV, by a
/// table of the attenuation of implants in J Nucl Med.
TEST(XrayMaterials, attenuation_is_a_little_more_than_published_values_without_coherent_scattering) {
  const auto a_little_more = [](double value, double published) {
    EXPECT_GT(value, published);
    EXPECT_LT(value, 1.13 * published);
  };
  a_little_more(per_cm(XrayMaterial::water, 50.0), 0.21);
  a_little_more(per_cm(XrayMaterial::water, 80.0), 0.18);
  a_little_more(per_cm(XrayMaterial::titanium, 50.0), 5.1);
  a_little_more(per_cm(XrayMaterial::titanium, 80.0), 1.65);
}

TEST(XrayMaterials, between_tabulated_energies_the_logarithm_is_linear_in_that_of_the_energy) {
  const double middle = std::sqrt(60.0 * 80.0);
  EXPECT_NEAR(mass_attenuation_cm2_per_g(XrayMaterial::titanium, middle), std::sqrt(0.7661 * 0.4052), 1e-9);
  // NIST, water at 70 keV by XCOM: 0.1929 cm²/g.
  EXPECT_NEAR(mass_attenuation_cm2_per_g(XrayMaterial::water, 70.0), 0.1929, 0.005 * 0.1929);
}

TEST(XrayMaterials, absorption_edges_stay_sharp) {
  EXPECT_GT(mass_attenuation_cm2_per_g(XrayMaterial::iodine, 33.2),
            5.0 * mass_attenuation_cm2_per_g(XrayMaterial::iodine, 33.1));
  EXPECT_GT(mass_attenuation_cm2_per_g(XrayMaterial::silver, 25.6),
            5.0 * mass_attenuation_cm2_per_g(XrayMaterial::silver, 25.5));
}

TEST(XrayMaterials, iodine_adds_in_proportion_to_its_concentration) {
  const double water = attenuation_per_mm(XrayMaterial::water, 60.0);
  EXPECT_DOUBLE_EQ(contrast_per_mm(0.0, 60.0), water);
  EXPECT_NEAR(contrast_per_mm(100.0, 60.0) - water, 0.1 * 0.1 * 7.579, 1e-12);
}

TEST(XrayMaterials, regions_darken_in_the_order_of_a_radiograph) {
  FluoroscopySettings settings;
  const auto of = [&](const char* region) { return region_attenuation_per_mm(region, settings); };
  EXPECT_LT(of("periprostatic_fat"), of("prostate"));
  EXPECT_LT(of("prostate"), of("pubic_arch"));
  EXPECT_LT(of("prostate"), of("bladder")) << "with contrast";
  settings.bladder_iodine_mg_per_ml = 0.0;
  EXPECT_LT(of("bladder"), of("prostate")) << "without contrast: water";
  EXPECT_EQ(of("label_7"), of("prostate")) << "an unknown region is soft tissue";
}

}  // namespace
}  // namespace stylet
