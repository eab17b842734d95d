// SPDX-License-Identifier: GPL-3.0-or-later
// The evaluation of plans, goals and dose grids.
#include "stylet/dose/evaluate.hpp"
#include "stylet/dose/fitting_sources.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace stylet {
namespace {

/// A ball of contours on planes 1 mm apart.
Roi ball(double radius, const std::string& name = "Prostate") {
  Roi roi;
  roi.name = name;
  for (double z = -std::floor(radius) + 0.5; z < radius; z += 1.0) {
    const double ring = std::sqrt(radius * radius - z * z);
    Contour contour;
    for (int k = 0; k < 120; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / 120;
      contour.points.emplace_back(ring * std::cos(angle), ring * std::sin(angle), z);
    }
    roi.contours.push_back(contour);
  }
  return roi;
}

DosePlan plan_of(int seeds, unsigned number) {
  std::mt19937 random(number);
  std::uniform_real_distribution<double> place(-12.0, 12.0), part(-1.0, 1.0);
  DosePlan plan;
  plan.file = "plan";
  plan.isotope = "I125";
  plan.frame_of_reference = "1.2.3";
  plan.prescription_Gy = 145.0;
  for (int k = 0; k < seeds; ++k) {
    PlannedSource seed;
    seed.at_mm = Vec3(place(random), place(random), place(random));
    seed.axis = Vec3(part(random), part(random), 3.0).normalized();
    seed.has_axis = true;
    seed.strength_U = 0.5;
    plan.sources.push_back(seed);
  }
  return plan;
}

DoseStructure structure_of(const Roi& roi, double step, const std::string& region) {
  return {roi.name, region, "", sample_structure(roi, step).value(), {}, roi.contours};
}

const SourceModel& source() {
  static const SourceModel model = find_source("i125_6711").value();
  return model;
}

TEST(EvaluateDose, gives_points_the_sum_of_the_seeds_rates_until_they_have_decayed) {
  const DosePlan plan = plan_of(30, 1);
  DoseOptions options;
  options.points = {Vec3(20, 0, 0), Vec3(3, -4, 25)};
  const DoseEvaluation e = evaluate_dose(plan, source(), {}, options).value();
  const Tg43 tg43 = Tg43::create(source(), DoseFormalism::line2d).value();
  for (std::size_t p = 0; p < options.points.size(); ++p) {
    double rate = 0.0;
    for (const PlannedSource& seed : plan.sources) {
      const Vec3 to = options.points[p] - seed.at_mm;
      rate += 0.5 * tg43.rate(to.norm(), to.normalized().dot(seed.axis));
    }
    EXPECT_NEAR(e.point_Gy[p] / (rate * 59.4 * 24.0 / std::numbers::ln2 / 100.0), 1.0, 1e-12);
  }
}

// A plan and its structures, turned and moved together, and with the seeds in another order.
TEST(EvaluateDose, does_not_depend_on_the_frame_or_on_the_order_of_the_seeds) {
  const DosePlan plan = plan_of(25, 2);
  const Roi roi = ball(15.0);
  DoseOptions options;
  options.points = {Vec3(18, 3, -2), Vec3(-6, 17, 9)};
  const std::vector<DoseStructure> structures{structure_of(roi, 0.5, "prostate")};
  const DoseEvaluation before = evaluate_dose(plan, source(), structures, options).value();

  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const Vec3 move(100.0, -40.0, 7.0);
  const auto moved = [&](const Vec3& x) { return Vec3(turn * x + move); };
  DosePlan other = plan;
  std::reverse(other.sources.begin(), other.sources.end());
  for (PlannedSource& seed : other.sources) {
    seed.at_mm = moved(seed.at_mm);
    seed.axis = turn * seed.axis;
  }
  Roi other_roi = roi;
  for (Contour& contour : other_roi.contours) {
    for (Vec3& x : contour.points) x = moved(x);
  }
  for (Vec3& x : options.points) x = moved(x);
  const std::vector<DoseStructure> other_structures{structure_of(other_roi, 0.5, "prostate")};
  const DoseEvaluation after = evaluate_dose(other, source(), other_structures, options).value();
  for (std::size_t p = 0; p < 2; ++p) EXPECT_NEAR(after.point_Gy[p] / before.point_Gy[p], 1.0, 1e-9);
  const DoseVolume& a = before.structures[0].dvh;
  const DoseVolume& b = after.structures[0].dvh;
  EXPECT_NEAR(b.dose_of_percent(90.0) / a.dose_of_percent(90.0), 1.0, 1e-3);
  EXPECT_NEAR(b.percent_above(145.0) / a.percent_above(145.0), 1.0, 1e-3);
  EXPECT_NEAR(b.dose_of_volume(2.0) / a.dose_of_volume(2.0), 1.0, 1e-3);
}

TEST(EvaluateDose, gives_half_of_the_total_dose_within_one_half_life) {
  const DosePlan plan = plan_of(5, 3);
  DoseOptions options;
  options.points = {Vec3(0, 0, 20)};
  const double total = evaluate_dose(plan, source(), {}, options).value().point_Gy[0];
  options.quantity = DoseQuantity::until;
  options.days = 59.4;
  EXPECT_NEAR(evaluate_dose(plan, source(), {}, options).value().point_Gy[0] / total, 0.5, 1e-12);
  options.quantity = DoseQuantity::initial_rate;
  const double rate = evaluate_dose(plan, source(), {}, options).value().point_Gy[0];
  EXPECT_NEAR(rate * 59.4 * 24.0 / std::numbers::ln2 / total, 1.0, 1e-12);
  options.quantity = DoseQuantity::total;
  options.decay_days = 59.4;
  EXPECT_NEAR(evaluate_dose(plan, source(), {}, options).value().point_Gy[0] / total, 0.5, 1e-12);
}

TEST(EvaluateDose, of_dwell_times_is_the_rate_times_the_time) {
  DosePlan plan = plan_of(1, 4);
  plan.isotope = "Ir-192";
  plan.implant = Implant::temporary;
  plan.sources[0].at_mm = Vec3::Zero();
  plan.sources[0].axis = Vec3::UnitZ();
  plan.sources[0].strength_U = 40000.0;
  plan.sources[0].dwell_s = 9.0;
  DoseOptions options;
  options.points = {Vec3(10, 0, 0)};
  const SourceModel hdr = find_source("ir192_mhdr_v2").value();
  // Λ S_K t: 1.109 cGy/(h U) · 40000 U · 0.0025 h = 110.9 cGy.
  // Within 9 s the source decays by a millionth.
  EXPECT_NEAR(evaluate_dose(plan, hdr, {}, options).value().point_Gy[0], 1.109, 1e-6);
}

TEST(EvaluateDose, refuses_a_source_model_of_another_isotope) {
  const Result<DoseEvaluation> e = evaluate_dose(plan_of(2, 5), find_source("pd103_theraseed200").value(), {}, {});
  ASSERT_FALSE(e.ok());
  EXPECT_NE(e.error().message().find("I-125"), std::string::npos) << e.error().message();
}

TEST(EvaluateDose, refuses_structures_that_do_not_hold_the_seeds) {
  DosePlan plan = plan_of(4, 6);
  for (PlannedSource& seed : plan.sources) seed.at_mm.x() += 500.0;
  const std::vector<DoseStructure> structures{structure_of(ball(15.0), 1.0, "prostate")};
  const Result<DoseEvaluation> e = evaluate_dose(plan, source(), structures, {});
  ASSERT_FALSE(e.ok());
  EXPECT_NE(e.error().message().find("away from the target"), std::string::npos) << e.error().message();
}

TEST(EvaluateDose, says_how_many_seeds_have_no_direction) {
  DosePlan plan = plan_of(4, 7);
  plan.sources[1].has_axis = false;
  const DoseEvaluation e = evaluate_dose(plan, source(), {}, {}).value();
  EXPECT_TRUE(std::any_of(e.assumptions.begin(), e.assumptions.end(), [](const std::string& s) {
    return s.find("1 of 4 sources have no direction") != std::string::npos;
  }));
}

TEST(CompareWithGrid, finds_the_ratio_of_a_grid_that_was_scaled_and_the_part_of_an_organ_that_it_holds) {
  const DosePlan plan = plan_of(20, 8);
  const std::vector<DoseStructure> structures{structure_of(ball(15.0), 0.5, "prostate")};
  DoseEvaluation e = evaluate_dose(plan, source(), structures, {}).value();
  DoseGrid grid = e.grid;
  const std::size_t before = e.warnings.size();
  for (float& dose : grid.dose_Gy) dose *= 0.5F;
  ASSERT_TRUE(compare_with_grid(e, grid, structures, {}).ok());
  EXPECT_NEAR(e.comparison->median_ratio, 2.0, 1e-5);
  EXPECT_NEAR(e.comparison->p1, 2.0, 1e-4);
  EXPECT_EQ(e.structures[0].covered_by_grid_percent, 100.0);
  EXPECT_EQ(e.warnings.size(), before + 1) << "the ratio is told";
  ASSERT_TRUE(e.comparison->gamma.has_value());
  EXPECT_LT(e.comparison->gamma->local_percent, 5.0) << "twice the dose passes nowhere";
  double largest = 0.0;
  for (std::size_t k = 0; k < grid.dose_Gy.size(); ++k) {
    const float difference = e.comparison->difference.dose_Gy[k];
    if (std::isfinite(difference) && grid.dose_Gy[k] < 1000.0F)
      largest = std::max<double>(largest, std::abs(difference / grid.dose_Gy[k] - 1.0F));
  }
  EXPECT_LT(largest, 1e-3) << "ours minus theirs is theirs";
  // The lower half of the grid only: half of the ball.
  grid.size[2] = static_cast<Index>(std::lround((0.0 - grid.origin_mm.z()) / grid.spacing_mm.z())) + 1;
  grid.origin_mm.z() = -grid.spacing_mm.z() * (grid.size[2] - 1);
  grid.dose_Gy.resize(grid.count());
  ASSERT_TRUE(compare_with_grid(e, grid, structures, {}).ok());
  EXPECT_NEAR(e.structures[0].covered_by_grid_percent, 50.0, 1.0);
}

TEST(CompareWithGrid, passes_gamma_with_its_own_dose_and_hardly_with_one_that_was_moved_by_three_millimetres) {
  DoseEvaluation e = evaluate_dose(plan_of(20, 8), source(), {}, {}).value();
  const DoseGrid grid = e.grid;
  ASSERT_TRUE(compare_with_grid(e, grid, {}, {}).ok());
  EXPECT_EQ(e.comparison->gamma->local_percent, 100.0);
  EXPECT_EQ(e.comparison->gamma->global_percent, 100.0);
  ASSERT_TRUE(compare_with_grid(e, grid, {}, {}, Vec3(0.5, 0.3, 0.0)).ok());
  EXPECT_GT(e.comparison->gamma->local_percent, 99.0) << "within the distance to agreement";
  ASSERT_TRUE(compare_with_grid(e, grid, {}, {}, Vec3(3.0, 0.0, 0.0)).ok());
  EXPECT_LT(e.comparison->gamma->local_percent, 50.0);
  EXPECT_LE(e.comparison->gamma->local_percent, e.comparison->gamma->global_percent + 1e-9);
}

TEST(DoseFigures, that_a_structure_is_too_small_for_are_left_out_with_the_reason) {
  const std::vector<DoseStructure> structures{structure_of(ball(6.5, "Urethra"), 0.25, "urethra"),
                                              structure_of(ball(15.0), 0.5, "prostate")};
  DoseOptions options;
  options.goals = {{"urethra", "D2cc_Gy", false, 1e6, "here"},
                   {"urethra", "D0.1cc_percent", false, 1e6, "here"},
                   {"prostate", "D2cc_percent", false, 1e6, "here"}};
  const DoseEvaluation e = evaluate_dose(plan_of(20, 8), source(), structures, options).value();
  EXPECT_FALSE(e.goals[0].value.has_value()) << "no 2 cc in 1.2 cc";
  EXPECT_TRUE(e.goals[1].value.has_value());
  EXPECT_TRUE(e.goals[2].value.has_value());
  const std::vector<std::string> told = figures_left_out(e.structures);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told[0].find("'Urethra' has 1."), std::string::npos) << told[0];
  EXPECT_NE(told[0].find("no D2cc."), std::string::npos) << told[0];
}

TEST(CompareWithGrid, refuses_a_grid_of_another_frame_of_reference) {
  DoseEvaluation e = evaluate_dose(plan_of(3, 9), source(), {}, {}).value();
  DoseGrid grid = e.grid;
  grid.frame_of_reference = "9.9.9";
  EXPECT_FALSE(compare_with_grid(e, grid, {}, {}).ok());
}

TEST(CompareWithGrid, refuses_a_grid_that_cannot_be_of_this_plan_unless_asked) {
  const std::vector<DoseStructure> structures{structure_of(ball(15.0), 1.0, "prostate")};
  DosePlan plan = plan_of(20, 8);
  plan.uid = "1.2.4";
  DoseOptions options;
  options.grid_step_mm = 2.0;
  const DoseEvaluation e = evaluate_dose(plan, source(), structures, options).value();
  DoseGrid own = e.grid;
  own.plan_uid = "1.2.4";
  own.type = "PHYSICAL";
  own.summation = "PLAN";
  std::vector<DoseGrid> wrong(6, own);
  wrong[0].plan_uid = "1.2.5";
  wrong[1].type = "EFFECTIVE";
  wrong[2].summation = "BEAM";
  wrong[3].origin_mm += Vec3(0, 0, 200);
  for (float& dose : wrong[4].dose_Gy) dose *= 100.0F;
  for (float& dose : wrong[5].dose_Gy) dose *= 0.01F;
  wrong[5].quantum_Gy = 1e-6;
  DoseEvaluation right = e;
  EXPECT_TRUE(compare_with_grid(right, own, structures, options).ok());
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    DoseEvaluation of = e;
    const Result<> done = compare_with_grid(of, wrong[k], structures, options);
    ASSERT_FALSE(done.ok()) << k;
    if (k == 5) continue;  // too little dose to compare at all
    EXPECT_NE(done.error().cure.find("--compare-anyway"), std::string::npos) << k;
    DoseOptions anyway = options;
    anyway.compare_anyway = true;
    EXPECT_TRUE(compare_with_grid(of, wrong[k], structures, anyway).ok()) << k;
    EXPECT_GT(of.warnings.size(), e.warnings.size()) << k;
  }
}

TEST(DoseGoals, are_judged_by_the_figures_of_their_structure) {
  const DosePlan plan = plan_of(40, 10);
  const std::vector<DoseStructure> structures{structure_of(ball(15.0), 0.5, "prostate")};
  DoseOptions options;
  options.goals = {{"prostate", "D90_Gy", true, 1.0, "here"},
                   {"prostate", "V100_cc", false, 0.1, "here"},
                   {"bladder", "D2cc_Gy", false, 100.0, "here"}};
  const DoseEvaluation e = evaluate_dose(plan, source(), structures, options).value();
  EXPECT_TRUE(e.goals[0].met);
  EXPECT_FALSE(e.goals[1].met);
  EXPECT_NEAR(*e.goals[1].value, e.structures[0].dvh.volume_above_cc(145.0), 1e-12);
  EXPECT_FALSE(e.goals[2].value.has_value()) << "the plan has no bladder";
}

TEST(DoseGoals, have_figures_with_an_amount_and_a_unit) {
  EXPECT_EQ(parse_metric("D0.1cc_percent", "x").value().amount, 0.1);
  EXPECT_EQ(parse_metric("V150_cc", "x").value().unit, DoseMetric::Unit::cc);
  for (const char* wrong : {"", "D90", "X90_Gy", "D_Gy", "V100_Gy", "D-2cc_Gy", "D190_Gy", "D90_cc", "D2cc_Gyy"})
    EXPECT_FALSE(parse_metric(wrong, "x").ok()) << wrong;
  for (const DoseGoal& goal : permanent_prostate_goals()) {
    EXPECT_TRUE(parse_metric(goal.metric, "x").ok()) << goal.metric;
    EXPECT_FALSE(goal.citation.empty());
  }
}

TEST(DoseGrid, interpolates_a_linear_dose_exactly_in_a_turned_frame) {
  DoseGrid grid;
  grid.size = {5, 4, 3};
  grid.origin_mm = Vec3(3, -2, 8);
  grid.spacing_mm = Vec3(1.0, 2.0, 2.5);
  grid.direction = Eigen::AngleAxisd(0.4, Vec3(1, 1, 2).normalized()).toRotationMatrix();
  const Vec3 slope(0.3, -0.7, 1.1);
  for (Index k = 0; k < 3; ++k) {
    for (Index j = 0; j < 4; ++j) {
      for (Index i = 0; i < 5; ++i) grid.dose_Gy.push_back(static_cast<float>(slope.dot(grid.point(i, j, k)) + 50.0));
    }
  }
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int n = 0; n < 100; ++n) {
    const Vec3 steps(4.0 * share(random), 3.0 * share(random), 2.0 * share(random));
    const Vec3 x = grid.origin_mm + grid.direction * grid.spacing_mm.cwiseProduct(steps);
    EXPECT_TRUE(grid.covers(x));
    EXPECT_NEAR(grid.at(x), slope.dot(x) + 50.0, 1e-5);
  }
  EXPECT_FALSE(grid.covers(grid.point(5, 0, 0)));
  EXPECT_FALSE(grid.covers(grid.point(0, -1, 0)));
}

TEST(FittingSources, are_those_of_isotope_and_length_however_the_isotope_is_written) {
  for (const char* name : {"I-125", "I125", "125I", "Iodine-125", "i 125"}) EXPECT_EQ(isotope_name(name), "I-125");
  DosePlan plan;
  plan.isotope = "125-I";
  EXPECT_EQ(fitting_sources(plan).size(), 4U);
  plan.source_length_mm = 4.5;
  for (const SourceModel& fit : fitting_sources(plan)) EXPECT_EQ(fit.isotope, "I-125");
  plan.isotope = "isotope";
  plan.half_life_days = 74.0;
  plan.source_length_mm = 3.5;
  for (const SourceModel& fit : fitting_sources(plan)) EXPECT_EQ(fit.isotope, "Ir-192") << "by its half-life";
  plan.isotope = "I-125";
  EXPECT_NE(unnamed_source(plan).message().find("i125_6711"), std::string::npos);
}

TEST(VolumeSamples, of_a_mesh_and_of_a_mask_have_the_volume_and_the_centre_of_the_structure) {
  TetMesh mesh = box_mesh(Vec3(0, 0, 0), Vec3(20, 12, 9), {3, 2, 2});
  for (Vec3& x : mesh.nodes) x += 0.05 * Vec3(x.y() * x.y(), 0.0, x.x());
  double volume = 0.0;
  Vec3 centre = Vec3::Zero();
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const double part = tet_volume(mesh, t);
    volume += part;
    for (const Index n : mesh.tets[static_cast<std::size_t>(t)])
      centre += 0.25 * part * mesh.nodes[static_cast<std::size_t>(n)];
  }
  const StructureSamples samples = sample_structure(mesh, 0, 1.0).value();
  Vec3 mean = Vec3::Zero();
  for (std::size_t k = 0; k < samples.points.size(); ++k) mean += samples.volume_mm3[k] * samples.points[k];
  EXPECT_NEAR(1000.0 * samples.volume_cc(), volume, 1e-9 * volume);
  EXPECT_LT((mean - centre).norm() / volume, 1e-9) << "equal parts of a tetrahedron have its centre";

  // About one sample for each cube of the step, also in long elements.
  TetMesh coarse;
  coarse.nodes = {Vec3(0, 0, 0), Vec3(60, 0, 0), Vec3(0, 40, 0), Vec3(0, 0, 2)};
  coarse.tets = {{0, 1, 2, 3}};
  coarse.tet_region = {0};
  coarse.regions = {"fat"};
  const double cubes = 1000.0 * sample_structure(coarse, 0, 0.5).value().volume_cc() / 0.125;
  EXPECT_GE(static_cast<double>(sample_structure(coarse, 0, 0.5).value().points.size()), cubes);
  EXPECT_LE(static_cast<double>(sample_structure(coarse, 0, 0.5).value().points.size()), 20.0 * cubes);

  LabelImage image;
  image.source = "mask";
  image.size = {10, 10, 4};
  image.spacing = Vec3(1.0, 1.5, 3.0);
  image.labels.assign(400, 0);
  for (std::size_t k = 0; k < 400; k += 3) image.labels[k] = 2;
  const StructureSamples voxels = sample_structure(image, 2, 0.5).value();
  EXPECT_NEAR(voxels.volume_cc(), 134 * 4.5 / 1000.0, 1e-9);
  EXPECT_EQ(voxels.points.size(), 134U * 2 * 3 * 6);
  EXPECT_FALSE(sample_structure(image, 7, 0.5).ok());
}

TEST(DoseGoal, is_met_at_its_bound_and_on_one_side_of_it) {
  for (const char* bound : {">=90", "> 90", "<=90", "<90"}) {
    const auto goal = parse_goal({"prostate", "D90_percent", bound, ""}, "here");
    ASSERT_TRUE(goal) << bound;
    EXPECT_TRUE(meets(*goal, 90.0)) << bound;
    EXPECT_EQ(meets(*goal, std::nextafter(90.0, 100.0)), bound[0] == '>') << bound;
    EXPECT_EQ(meets(*goal, std::nextafter(90.0, 0.0)), bound[0] == '<') << bound;
  }
}

}  // namespace
}  // namespace stylet
