// SPDX-License-Identifier: GPL-3.0-or-later
// Source models: those that the program has are sound, and others are checked.
#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/tg43.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace stylet {
namespace {

TEST(KnownSources, are_sound_cited_and_named_once) {
  std::set<std::string> names;
  for (const SourceModel& source : known_sources()) {
    EXPECT_TRUE(check_source(source, source.name).ok()) << source.name;
    EXPECT_TRUE(names.insert(source.name).second) << source.name << " twice";
    EXPECT_FALSE(source.citation.empty()) << source.name;
    EXPECT_FALSE(source.title.empty()) << source.name;
    EXPECT_LT(source.active_length_mm, source.outer_length_mm) << source.name;
  }
  EXPECT_EQ(names.size(), 10u);
}

TEST(KnownSources, have_a_radial_function_of_one_at_the_reference_and_an_anisotropy_of_one_across) {
  for (const SourceModel& source : known_sources()) {
    const Tg43 tg43 = Tg43::create(source, DoseFormalism::line2d).value();
    EXPECT_NEAR(tg43.radial(10.0), 1.0, 1e-9) << source.name;
    EXPECT_NEAR(tg43.anisotropy(10.0, 90.0), 1.0, 1e-3) << source.name;
    EXPECT_NEAR(tg43.rate(10.0, 0.0), source.dose_rate_constant, 1e-3 * source.dose_rate_constant) << source.name;
    EXPECT_LT(tg43.mean_anisotropy(10.0), 1.02) << source.name << ": a capsule absorbs at its ends";
    EXPECT_GT(tg43.mean_anisotropy(10.0), 0.8) << source.name;
  }
}

// φ_an that TG-43U1 gives for model 6711 follows from its F.
TEST(KnownSources, of_model_6711_agree_in_both_anisotropy_functions) {
  SourceModel source = find_source("i125_6711").value();
  const Tg43 given = Tg43::create(source, DoseFormalism::line1d).value();
  source.phi.clear();
  source.phi_r_mm.clear();
  const Tg43 computed = Tg43::create(source, DoseFormalism::line1d).value();
  for (const double r : {5.0, 10.0, 20.0, 30.0, 40.0, 50.0})
    EXPECT_NEAR(computed.mean_anisotropy(r) / given.mean_anisotropy(r), 1.0, 0.003) << r << " mm";
}

TEST(KnownSources, that_do_not_exist_are_refused_with_the_nearest_name) {
  const auto wrong = find_source("i125_6712");
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().message().find("Did you mean 'i125_6711'?"), std::string::npos) << wrong.error().message();
  const auto far = find_source("something of another kind");
  ASSERT_FALSE(far.ok());
  EXPECT_NE(far.error().message().find("pd103_theraseed200"), std::string::npos) << far.error().message();
}

TEST(SourceModel, that_cannot_be_used_is_refused_with_place_and_value) {
  struct Bad {
    std::function<void(SourceModel&)> spoil;
    const char* says;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Bad& bad : {Bad{[](SourceModel& s) { s.half_life_days = 0.0; }, "half-life: it is 0"},
                         Bad{[&](SourceModel& s) { s.dose_rate_constant = nan; }, "dose-rate constant: it is nan"},
                         Bad{[](SourceModel& s) { s.active_length_mm = -3.0; }, "active length: it is -3 mm"},
                         Bad{[](SourceModel& s) { s.g.pop_back(); }, "g: 15 values for 16 radii"},
                         Bad{[](SourceModel& s) { s.g[3] = -1.0; }, "g: at 5 mm it is -1"},
                         Bad{[](SourceModel& s) { s.g_r_mm[2] = 0.5; }, "value 3 is 0.5, expected ascending"},
                         Bad{[](SourceModel& s) { s.g.clear(), s.g_r_mm.clear(); }, "g: the table is empty"},
                         Bad{[](SourceModel& s) { s.g_r_mm = {1.0}, s.g = {1.0}; }, "g: the last radius is 1 mm"},
                         Bad{[](SourceModel& s) { s.F_theta_deg.back() = 270.0; }, "angles of F: value 11 is 270"},
                         Bad{[](SourceModel& s) { s.F_r_mm.push_back(60.0); }, "11 × 6 values for 11 angles and 7"},
                         Bad{[](SourceModel& s) { s.F(2, 1) = 0.0; }, "F: at 10 degrees and 10 mm it is 0"},
                         Bad{[&](SourceModel& s) { s.F(0, 5) = nan; }, "F: at 0 degrees and 50 mm it is nan"},
                         Bad{[](SourceModel& s) { s.phi.pop_back(); }, "phi_an: 5 values for 6 radii"},
                         // With such numbers doses overflow.
                         Bad{[](SourceModel& s) { s.half_life_days = 1e308; }, "half-life: it is 1e+308"},
                         Bad{[](SourceModel& s) { s.dose_rate_constant = 1e300; }, "constant: it is 1e+300"},
                         Bad{[](SourceModel& s) { s.active_length_mm = 1e9; }, "active length: it is 1e+09 mm"},
                         Bad{[](SourceModel& s) { s.g[3] = 1e308; }, "g: at 5 mm it is 1e+308"},
                         Bad{[](SourceModel& s) { s.F(2, 1) = 1e308; }, "F: at 10 degrees and 10 mm it is 1e+308"},
                         Bad{[](SourceModel& s) { s.phi[1] = 1e30; }, "phi_an: at"}}) {
    SourceModel source = find_source("i125_6711").value();
    bad.spoil(source);
    const auto made = Tg43::create(source, DoseFormalism::line2d);
    ASSERT_FALSE(made.ok()) << bad.says;
    EXPECT_NE(made.error().message().find(bad.says), std::string::npos) << made.error().message();
    EXPECT_NE(made.error().message().find("source i125_6711"), std::string::npos) << made.error().message();
  }
}

}  // namespace
}  // namespace stylet
