// SPDX-License-Identifier: GPL-3.0-or-later
// The same insertion with every needle model: they are models of one needle.
#include "box_patient.hpp"

#include <algorithm>
#include <cmath>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A thin needle, which bends and buckles well before the capsule breaks.
Scenario thin_needle(const std::string& model) {
  Scenario s = box_scenario();
  s.needle.model = model;
  s.needle.diameter_mm = 1.0;
  s.needle.bending_stiffness_Nmm2 = 4000.0;
  return s;
}

const Finished& finished(const std::string& model) {
  static const Finished beam(compiled(thin_needle("beam")));
  static const Finished springs(compiled(thin_needle("springs")));
  static const Finished tet(compiled(thin_needle("tet")));
  return model == "beam" ? beam : model == "springs" ? springs : tet;
}

/// Base force axial, sagittal, lateral [N].
Vec3 force(const StepRecord& step) { return {step.force_axial_N, step.force_sagittal_N, step.force_lateral_N}; }

const ParameterRow* row(const RunInfo& info, const std::string& name) {
  const auto found =
      std::find_if(info.parameters.begin(), info.parameters.end(), [&](const auto& r) { return r.name == name; });
  return found == info.parameters.end() ? nullptr : &*found;
}

}  // namespace

TEST(NeedleModels, TheSameThingsHappenAtTheSameDepth) {
  const auto& expected = finished("beam").summary.events;
  for (const char* model : {"springs", "tet"}) {
    const auto& events = finished(model).summary.events;
    ASSERT_EQ(events.size(), expected.size()) << model;
    for (std::size_t k = 0; k < events.size(); ++k) {
      EXPECT_EQ(events[k].kind, expected[k].kind) << model << ' ' << k;
      EXPECT_NEAR(events[k].depth_mm, expected[k].depth_mm, 0.25) << model << ' ' << k;
    }
  }
}

TEST(NeedleModels, BaseForcesAndTipAgree) {
  const auto& expected = finished("beam").kept.steps;
  double peak = 0.0;
  for (const StepRecord& step : expected) peak = std::max(peak, force(step).norm());
  for (const char* model : {"springs", "tet"}) {
    const auto& steps = finished(model).kept.steps;
    ASSERT_EQ(steps.size(), expected.size());
    double squares = 0.0;
    double apart = 0.0;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      squares += (force(steps[k]) - force(expected[k])).squaredNorm();
      apart = std::max(apart, (steps[k].tip_mm - expected[k].tip_mm).norm());
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(steps.size())), 0.02 * peak) << model;
    EXPECT_LT(apart, 0.2) << model;
    EXPECT_NEAR(finished(model).summary.peak_axial_N, finished("beam").summary.peak_axial_N, 0.02 * peak) << model;
  }
}

TEST(NeedleModels, NewtonNeedsAsFewIterationsWithEach) {
  for (const char* model : {"beam", "springs", "tet"}) {
    double sum = 0.0;
    double count = 0.0;
    for (const StepRecord& step : finished(model).kept.steps) {
      if (step.iterations == 0) continue;
      sum += step.iterations;
      ++count;
    }
    EXPECT_LT(sum / count, 6.0) << model;
    EXPECT_LT(finished(model).summary.residual_force_balance, 1e-9) << model;
    for (const std::string& warning : finished(model).summary.warnings)
      EXPECT_FALSE(contains(warning, "converge")) << model << ": " << warning;
  }
}

TEST(NeedleModels, AReportShowsTheModelItsElementsAndTheCalibrationOfTetrahedra) {
  const RunInfo tet = finished("tet").model->info(0);
  ASSERT_NE(row(tet, "needle.tet.calibration"), nullptr);
  EXPECT_GT(std::stod(row(tet, "needle.tet.calibration")->value), 0.1);
  EXPECT_LT(std::stod(row(tet, "needle.tet.calibration")->value), 1.0);
  EXPECT_EQ(row(tet, "needle.model")->value, "tet");
  EXPECT_EQ(row(tet, "needle.elements")->value, "60");
  const RunInfo beam = finished("beam").model->info(0);
  EXPECT_EQ(row(beam, "needle.tet.calibration"), nullptr);
  EXPECT_EQ(row(beam, "needle.elements")->value, "24");
}
