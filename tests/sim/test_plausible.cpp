// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/plausible.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace stylet {
namespace {

Scenario plain() {
  Scenario s;
  s.patient.source = "phantom";
  s.insertions = {{.hole = "D4"}};
  return s;
}

Scenario with(const std::string& key, double value, Scenario s = plain()) {
  const Result<> set = set_scenario_key(s, key, {.type = ScenarioValue::Type::number, .number = value}, "the test");
  EXPECT_TRUE(set.ok()) << set.error().message();
  return s;
}

std::string said(const Scenario& s) {
  std::string all;
  for (const std::string& warning : warnings_before_start(s)) all += warning + '\n';
  return all;
}

void expect_said(const Scenario& s, const std::vector<std::string>& texts) {
  const std::string all = said(s);
  for (const std::string& text : texts) EXPECT_NE(all.find(text), std::string::npos) << text << " in: " << all;
}

TEST(WarningsBeforeStart, are_none_for_the_defaults_of_all_tissues) {
  for (const TissuePreset preset :
       {TissuePreset::typical, TissuePreset::firm, TissuePreset::soft, TissuePreset::linear}) {
    Scenario s = plain();
    s.tissue_model.preset = preset;
    for (const std::string& region : known_tissues()) s.tissue[region] = default_tissue(region, preset);
    EXPECT_EQ(said(s), "");
  }
}

TEST(WarningsBeforeStart, name_the_key_the_bounds_and_the_unit_that_was_probably_meant) {
  expect_said(with("tissue.prostate.friction_static_N_per_m", 0.06),
              {"tissue.prostate.friction_static_N_per_m = 0.06 N/m is less than is plausible, 2 to 400 N/m", "N/mm"});
  expect_said(with("tissue.prostate.friction_static_N_per_m", 6000), {"more than is plausible", "kPa"});
  expect_said(with("tissue.prostate.young_kPa", 0.16), {"MPa has to be multiplied by 1000"});
  expect_said(with("tissue.prostate.young_kPa", 60000), {"Pa has to be divided by 1000"});
  expect_said(with("insertion[0].speed_mm_per_s", 0.02), {"insertion[0].speed_mm_per_s = 0.02 mm/s", "m/s"});
  expect_said(with("insertion[0].depth_mm", 6), {"insertion[0].depth_mm = 6 mm", "cm has to be multiplied by 10"});
  expect_said(with("insertion[0].dwell_s", 300), {"insertion[0].dwell_s = 300 s", "ms has to be divided by 1000"});
  expect_said(with("run.dt_ms", 0.01), {"run.dt_ms = 0.01 ms", "s has to be multiplied by 1000"});
  expect_said(with("tissue.prostate.puncture_N", 43), {"mN has to be divided by 1000"});
}

TEST(WarningsBeforeStart, tell_of_angles_in_radians) {
  expect_said(with("insertion[0].roll_deg", 1.5708), {"insertion[0].roll_deg = 1.5708", "90 degrees in radians"});
  expect_said(with("needle.bow_deg", -0.7854), {"-45 degrees in radians"});
  EXPECT_EQ(said(with("insertion[0].roll_deg", 2.5)), "");
  EXPECT_EQ(said(with("insertion[0].roll_deg", 90)), "");
}

/// Whoever adds a range for a key that does not exist, or bounds outside of what is possible, is told here.
TEST(PlausibleRanges, are_of_keys_and_give_a_reason_and_bounds_in_order) {
  const auto& keys = scenario_keys();
  for (const PlausibleRange& range : plausible_ranges()) {
    EXPECT_TRUE(std::any_of(keys.begin(), keys.end(), [&](const auto& k) { return k.path == range.key; })) << range.key;
    EXPECT_LT(range.low, range.high) << range.key;
    EXPECT_FALSE(range.reason.empty()) << range.key;
  }
}

TEST(WarningsBeforeStart, tell_of_a_needle_that_comes_from_the_head) {
  Scenario s = plain();
  s.insertions[0].hole.reset();
  s.insertions[0].entry_mm = {0, 0, 80};
  s.insertions[0].direction = {0.1, 0, -1};
  expect_said(s, {"insertion[0]", "from superior to inferior", "came from the head"});
  s.insertions[0].direction.reset();
  s.insertions[0].target_mm = {0, 0, 0};
  expect_said(s, {"came from the head"});
  s.insertions[0].entry_mm = {0, 0, -80};
  EXPECT_EQ(said(s), "");
}

TEST(WarningsBeforeStart, tell_of_a_run_of_hours_with_its_steps) {
  EXPECT_EQ(long_work_warning(plain()), "");
  expect_said(with("insertion[0].speed_mm_per_s", 0.01), {"This will take about", "minutes", "steps of 1 ms"});
  expect_said(with("insertion[0].dwell_s", 3600, with("run.dt_ms", 0.1)), {"hours", "3.61e+07 steps"});
  expect_said(with("mesh.nodes", 1000000), {"hours", "GB of memory", "a mesh of 1000000 nodes", "Fewer nodes"});
  EXPECT_NE(long_work_warning(plain(), 36000.0), "") << "a recorded motion of ten hours";
  EXPECT_DOUBLE_EQ(estimate_work(with("run.dt_ms", 0.5)).steps, 2.0 * estimate_work(plain()).steps);
  EXPECT_GT(estimate_work(with("mesh.nodes", 10000)).memory_GB, estimate_work(with("mesh.nodes", 1000)).memory_GB);
  EXPECT_EQ(work_text(75.0, 0.66), "about 75 seconds of processor time and 0.7 GB of memory");
}

}  // namespace
}  // namespace stylet
