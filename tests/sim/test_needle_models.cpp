// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the same insertion with every needle model: all of them describe the same needle.
#include "box_patient.hpp"

#include <algorithm>
#include <cmath>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A thin needle, which bends and buckles well before the capsule breaks.
Scenario thin_needle(const std::string& model) {
  Scenario s = box_scenario();
  s.needle.model = choice<NeedleModel>(model).value();
  s.needle.diameter_mm = 1.0;
  s.needle.bending_stiffness_Nmm2 = 4000.0;
  return s;
}

/// Force of the hand [N]: axial, sagittal, lateral.
Vec3 force(const Step& step) { return {step.force_axial_N, step.force_sagittal_N, step.force_lateral_N}; }

const ParameterRow* row(const RunInfo& info, const std::string& name) {
  const auto found =
      std::find_if(info.parameters.begin(), info.parameters.end(), [&](const auto& r) { return r.name == name; });
  return found == info.parameters.end() ? nullptr : &*found;
}

}  // namespace

TEST(NeedleModels, an_insertion_is_the_same_with_each) {
  const Finished beam(compiled(thin_needle("beam")));
  double peak = 0.0;
  for (const Step& step : beam.kept.steps) peak = std::max(peak, force(step).norm());
  for (const char* model : {"springs", "tet"}) {
    SCOPED_TRACE(model);
    const Finished other(compiled(thin_needle(model)));

    ASSERT_EQ(other.summary.events.size(), beam.summary.events.size());
    for (std::size_t k = 0; k < other.summary.events.size(); ++k) {
      EXPECT_EQ(other.summary.events[k].kind, beam.summary.events[k].kind) << k;
      EXPECT_NEAR(other.summary.events[k].depth_mm, beam.summary.events[k].depth_mm, 0.25) << k;
    }

    ASSERT_EQ(other.kept.steps.size(), beam.kept.steps.size());
    double squares = 0.0;
    double apart = 0.0;
    double iterations = 0.0;
    double steps = 0.0;
    for (std::size_t k = 0; k < beam.kept.steps.size(); ++k) {
      const Step& step = other.kept.steps[k];
      squares += (force(step) - force(beam.kept.steps[k])).squaredNorm();
      apart = std::max(apart, (step.tip_mm - beam.kept.steps[k].tip_mm).norm());
      iterations += step.iterations;
      steps += step.iterations > 0 ? 1.0 : 0.0;
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(beam.kept.steps.size())), 0.02 * peak);
    EXPECT_NEAR(other.summary.peak_axial_N, beam.summary.peak_axial_N, 0.02 * peak);
    EXPECT_LT(apart, 0.2);
    EXPECT_LT(iterations / steps, 6.0);
    EXPECT_LT(other.summary.residual_force_balance, 1e-9);
    for (const std::string& warning : other.summary.warnings) EXPECT_FALSE(contains(warning, "converge")) << warning;
  }
}

TEST(NeedleModels, a_report_shows_the_model_its_elements_and_the_calibration_of_tetrahedra) {
  const RunInfo tet = compiled(thin_needle("tet"))->info(0);
  ASSERT_NE(row(tet, "needle.tet.calibration"), nullptr);
  EXPECT_GT(std::stod(row(tet, "needle.tet.calibration")->value), 0.1);
  EXPECT_LT(std::stod(row(tet, "needle.tet.calibration")->value), 1.0);
  EXPECT_EQ(row(tet, "needle.model")->value, "tet");
  EXPECT_EQ(row(tet, "needle.elements")->value, "60");
  const RunInfo beam = compiled(thin_needle("beam"))->info(0);
  EXPECT_EQ(row(beam, "needle.tet.calibration"), nullptr);
  EXPECT_EQ(row(beam, "needle.elements")->value, "24");
}

TEST(NeedleSectionOfAScenario, stylet_and_lumen_decide_the_stiffness_unless_it_is_given) {
  const auto stiffness = [](const Scenario& s) {
    const RunInfo info = compiled(s)->info();
    return std::stod(row(info, "needle.bending_stiffness_Nmm2")->value);
  };
  Scenario s = box_scenario();
  EXPECT_EQ(stiffness(s), 15722.0);
  s.needle.lumen_diameter_mm = 0.838;
  EXPECT_NEAR(stiffness(s), 20.7e3, 100.0);
  s.needle.lumen_diameter_mm = 1.0;
  s.needle.stylet = StyletPlace::in;
  EXPECT_NEAR(stiffness(s), 15722.0 + 200e3 * 0.0322062, 1.0);
  s.needle.stylet_diameter_mm = 0.8;
  EXPECT_NEAR(stiffness(s), 15722.0 + 200e3 * 0.0201062, 1.0);
  s.needle.bending_stiffness_Nmm2 = 18000.0;
  EXPECT_EQ(stiffness(s), 18000.0);
  EXPECT_EQ(row(compiled(s)->info(), "needle.bending_stiffness_Nmm2")->source, "scenario");
  s.needle.lumen_diameter_mm = 1.3;
  EXPECT_SAYS(refused(s).message(), "lumen diameter");
}

TEST(NeedleSectionOfAScenario, the_tubes_wall_decides_how_much_it_stretches) {
  Scenario s = box_scenario();
  const double thin = compiled(s)->coupling().axial_compliance_mm_per_N;
  EXPECT_NEAR(thin, 120.0 / (200e3 * 0.48137), 1e-7);
  s.needle.stylet = StyletPlace::in;  // slides freely, so it does not make the tube stiffer axially
  EXPECT_EQ(compiled(s)->coupling().axial_compliance_mm_per_N, thin);
  s.needle.lumen_diameter_mm = 0.0;
  s.needle.stylet = StyletPlace::out;
  EXPECT_NEAR(compiled(s)->coupling().axial_compliance_mm_per_N, 120.0 / (200e3 * 1.266769), 1e-7);
}

TEST(GuideTemplate, holds_the_needle_of_a_run_and_is_part_of_its_balance) {
  for (const char* model : {"beam", "tet"}) {
    SCOPED_TRACE(model);
    Scenario s = thin_needle(model);
    s.tissue_model.preset = TissuePreset::linear;
    s.grid.guide = true;
    s.grid.distance_mm = 15.0;
    s.needle.bow_mm = 3.0;
    const Finished run(compiled(s));
    EXPECT_LT(run.summary.residual_force_balance, 1e-9);
    for (const std::string& warning : run.summary.warnings) EXPECT_FALSE(contains(warning, "converge")) << warning;
    ASSERT_NE(run.event(EventKind::withdrawn), nullptr);
    // The hole brings the bowed tip nearer to its line than without a guide.
    Scenario open = s;
    open.grid.guide = false;
    const auto first_tip = [](const Scenario& scenario) {
      const Finished made(compiled(scenario));
      return (made.kept.steps.front().tip_mm - Vec3(4.0, 7.0, 0.0)).head<2>().norm();
    };
    EXPECT_NEAR(first_tip(open), 3.0, 1e-6);
    EXPECT_LT((run.kept.steps.front().tip_mm - Vec3(4.0, 7.0, 0.0)).head<2>().norm(), 1.5);
    EXPECT_EQ(row(run.model->info(), "template.distance_mm")->value, "15");
  }
}

TEST(GuideTemplate, the_base_stops_before_it) {
  Scenario s = box_scenario();
  s.insertions[0].depth_mm = 30.0;
  s.grid.guide = true;
  s.grid.distance_mm = 90.0;
  EXPECT_SAYS(refused(s).what, "the template's distance, 90 mm (25)");
}

/// Offset [mm] of a bevelled tip from the needle's line at the deepest point.
Vec3 deepest_tip(const Scenario& s, const std::vector<std::vector<MotionSample>>& motions = {}) {
  const Finished run(compiled(s, box_patient(), motions));
  const auto deepest = std::max_element(run.kept.steps.begin(), run.kept.steps.end(),
                                        [](const auto& a, const auto& b) { return a.base_depth_mm < b.base_depth_mm; });
  return deepest->tip_mm - Vec3(4.0, 7.0, deepest->tip_mm.z());
}

TEST(BevelOfAScenario, roll_turns_it_in_planned_and_in_recorded_motions) {
  Scenario s = box_scenario();
  const Vec3 straight = deepest_tip(s);
  s.needle.bevel_deg = 25.0;
  const Vec3 left = deepest_tip(s) - straight;
  EXPECT_GT(left.x(), 0.1);  // LPS: x is the patient's left
  EXPECT_GT(left.x(), 3.0 * std::abs(left.y()));
  s.insertions[0].roll_deg = 90.0;
  const Vec3 posterior = deepest_tip(s) - straight;
  EXPECT_GT(posterior.y(), 0.1);
  EXPECT_GT(posterior.y(), 3.0 * std::abs(posterior.x()));

  const std::vector<MotionSample> recorded = compiled(s)->insertions()[0].motion.samples();
  Scenario follows = s;
  follows.insertions[0] = {};
  follows.insertions[0].motion = "recorded.csv";
  EXPECT_LT((deepest_tip(follows, {recorded}) - straight - posterior).norm(), 1e-3);
  follows.insertions[0].roll_deg = 90.0;
  EXPECT_SAYS(refused(follows, box_patient(), {recorded}).what, "recorded motion and roll_deg");
}

TEST(BevelOfAScenario, the_law_is_the_one_named) {
  Scenario s = box_scenario();
  s.needle.bevel_deg = 20.0;
  EXPECT_TRUE(compiled(s)->coupling().bevel.offsets());
  s.needle.bevel_law = Bevel::Law::force;
  s.needle.bevel_force_ratio = 0.04;
  EXPECT_TRUE(compiled(s)->coupling().bevel.pushes());
  EXPECT_EQ(compiled(s)->coupling().bevel.force_ratio, 0.04);
}
