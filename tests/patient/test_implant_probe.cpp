// SPDX-License-Identifier: GPL-3.0-or-later
// A small implant in the demo patient, while a probe presses.
#include "stylet/io/scenario_io.hpp"
#include "stylet/patient/implant.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace stylet {
namespace {

ImplantOutcome implanted(std::vector<std::string> settings) {
  const std::string text = R"(
name = "two needles"
[patient]
source = "phantom"
[fixed]
outer = "sides"
[mesh]
nodes = 1500
[template]
centre_mm = [0.0, 0.2]
[plan]
source = "i125_6711"
strength_U = 0.5
prescription_Gy = 145
base_mm = 20
[[plan.needle]]
hole = "C4"
retraction_mm = 5
train = "S-1-S-1-S"
[[plan.needle]]
hole = "E4"
retraction_mm = 10
train = "S-1-S"
[procedure]
speed_mm_per_s = 60
pause_s = 0.2
drop_speed_mm_per_s = 20
retract_speed_mm_per_s = 60
[run]
dt_ms = 8
)";
  const auto scenario = parse_scenario(text, "case.toml", settings);
  EXPECT_TRUE(scenario.ok()) << scenario.error().message();
  auto outcome = implant(*scenario, "case.toml");
  EXPECT_TRUE(outcome.ok()) << outcome.error().message();
  return *std::move(outcome);
}

const ImplantOutcome& unprobed() {
  static const ImplantOutcome outcome = implanted({});
  return outcome;
}

double d90(const DoseEvaluation& dose) {
  for (const StructureDose& structure : dose.structures) {
    if (structure.region == "prostate") return structure.dvh.dose_of_percent(90.0);
  }
  ADD_FAILURE() << "no prostate";
  return 0.0;
}

Vec3 mean_by_probe(const ImplantOutcome& outcome) {
  Vec3 sum = Vec3::Zero();
  for (const SeedHistory& seed : outcome.history.seeds) sum += seed.by(SeedCause::probe);
  return sum / static_cast<double>(outcome.history.seeds.size());
}

}  // namespace

TEST(ImplantUnderAProbe, leaves_seeds_behind_when_the_gland_goes_back) {
  const ImplantOutcome outcome = implanted({"probe.kind=biplane", "probe.lift_mm=8"});
  ASSERT_TRUE(outcome.probe);
  EXPECT_FALSE(outcome.probe_out) << "the delivered dose is without the probe already";
  // The gland has been lifted, the needles have gone to their places in the room: with the probe out the seeds go back
  // with the gland, by about as much as it was lifted.
  const Vec3& lifted = outcome.probe->gland.shift_mm;
  EXPECT_LT(lifted.y(), -0.5);
  const Vec3 mean = mean_by_probe(outcome);
  EXPECT_NEAR(mean.y(), -lifted.y(), 0.5 * std::abs(lifted.y()));
  for (const SeedHistory& seed : outcome.history.seeds) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& cause : seed.cause_mm) sum += cause;
    EXPECT_LT((sum - seed.error_mm()).norm(), 1e-9);
    EXPECT_GT(seed.by(SeedCause::probe).y(), 0.0);
  }
  EXPECT_GT(seed_errors(outcome.history.seeds).mean_mm, seed_errors(unprobed().history.seeds).mean_mm);
}

TEST(ImplantUnderAProbe, that_is_where_the_needles_go_or_pushes_the_rectum_there_says_so) {
  const auto harms = [](const ImplantOutcome& outcome, const char* of) {
    return std::count_if(outcome.warnings.begin(), outcome.warnings.end(),
                         [&](const std::string& warning) { return warning.find(of) != std::string::npos; });
  };
  const ImplantOutcome outcome = implanted({"probe.kind=biplane", "probe.lift_mm=25", "plan.needle[0].hole=D2.5"});
  EXPECT_GE(harms(outcome, "would come to rest in the probe") + harms(outcome, "came to rest in the rectum"), 1);
  EXPECT_EQ(harms(unprobed(), "would come to rest in the probe") + harms(unprobed(), "came to rest in the rectum"), 0);
}

TEST(ImplantUnderAProbe, of_the_contours_is_as_without_one_until_the_probe_is_taken_out) {
  const ImplantOutcome outcome = implanted({"probe.kind=biplane", "probe.lift_mm=8", "probe.in_contours=true"});
  ASSERT_TRUE(outcome.probe && outcome.probe_out);
  // The lumen around a probe is softer, which changes the needles' tissue a little.
  for (std::size_t k = 0; k < outcome.history.seeds.size(); ++k) {
    EXPECT_EQ(outcome.history.seeds[k].by(SeedCause::probe), Vec3::Zero());
    EXPECT_LT((outcome.history.seeds[k].rest_mm - unprobed().history.seeds[k].rest_mm).norm(), 0.3);
  }
  // Gland and seeds go back together; only their strain changes the dose.
  const double in = d90(outcome.delivered), out = d90(*outcome.probe_out);
  EXPECT_NE(in, out);
  EXPECT_NEAR(out, in, 0.2 * in);
}

TEST(ImplantUnderAProbe, is_refused_in_a_patient_whom_nothing_holds) {
  Scenario scenario = unprobed().scenario;
  scenario.probe.kind = ProbeKind::biplane;
  scenario.fixed.box_mm = {900, 900, 900, 901, 901, 901};
  const auto outcome = implant(scenario, "case.toml");
  ASSERT_FALSE(outcome.ok());
  EXPECT_NE(outcome.error().message().find("fixed.box_mm"), std::string::npos) << outcome.error().message();
}

}  // namespace stylet
