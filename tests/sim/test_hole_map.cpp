// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/hole_map.hpp"

#include "box_patient.hpp"
#include "stylet/sim/plan.hpp"

#include <algorithm>
#include <array>

namespace stylet {
namespace {

using namespace test;

/// The box patient with a template of few holes in front of the gland's centre, which is at (0, 5) mm.
Scenario scenario_with_template() {
  Scenario s = box_scenario();
  s.insertions[0].entry_mm.reset();
  s.insertions[0].hole = "B2";
  s.grid.columns = {"A", "B", "C"};
  s.grid.rows = {"1", "2", "3"};
  s.grid.pitch_mm = 10.0;
  s.grid.centre_mm = {0.0, 5.0};
  return s;
}

const HoleRow& row_of(const HoleMap& map, const std::string& hole) {
  const auto row = std::find_if(map.holes.begin(), map.holes.end(), [&](const HoleRow& r) { return r.hole == hole; });
  if (row == map.holes.end()) throw std::runtime_error("no row for hole " + hole);
  return *row;
}

/// The same plan for each hole.
PlanOfHole through_each(const InsertionPlan& plan) {
  return [plan](const std::string& hole) { return plan_through(plan, hole); };
}

HoleMap ways_of(const Scenario& scenario, TetMesh mesh = box_patient()) {
  const auto model = compiled(scenario, std::move(mesh));
  const auto map = map_ways(*model, through_each(scenario.insertions.front()), "case.toml");
  if (!map) throw std::runtime_error(map.error().message());
  return *map;
}

TEST(HoleMap, lists_holes_as_one_looks_at_the_template) {
  const HoleMap map = ways_of(scenario_with_template());
  std::vector<std::string> holes;
  for (const HoleRow& row : map.holes) holes.push_back(row.hole);
  EXPECT_EQ(holes, (std::vector<std::string>{"A3", "B3", "C3", "A2", "B2", "C2", "A1", "B1", "C1"}));
  EXPECT_EQ(map.missing, 0);
  EXPECT_EQ(map.planned, "B2");
  EXPECT_EQ(row_of(map, "C1").left_mm, 10.0);
  EXPECT_EQ(row_of(map, "C1").anterior_mm, -10.0);
}

TEST(HoleMap, counts_holes_whose_way_misses_the_target) {
  Scenario s = scenario_with_template();
  s.grid.pitch_mm = 20.0;  // the gland has a radius of 17 mm
  const HoleMap map = ways_of(s);
  ASSERT_EQ(map.holes.size(), 1U);
  EXPECT_EQ(map.holes.front().hole, "B2");
  EXPECT_EQ(map.missing, 8);
}

TEST(HoleMap, a_way_that_ends_before_the_target_misses_it) {
  Scenario s = scenario_with_template();
  s.insertions[0].depth_mm = 18.0;  // the gland begins about 15 mm deep on its axis, deeper beside it
  const HoleMap map = ways_of(s);
  EXPECT_GT(map.missing, 0);
  EXPECT_GT(row_of(map, "B2").in_target_mm, 0.0);
  EXPECT_EQ(row_of(map, "B2").depth_mm, 18.0);
}

TEST(HoleMap, clearance_is_from_the_needles_surface_to_the_bone) {
  // The pubic arch of the box consists of whole cells: everything anterior of y = −20.
  const HoleMap map = ways_of(scenario_with_template());
  const double radius = 0.5 * scenario_with_template().needle.diameter_mm;
  const auto to_bone = [&](const std::string& hole) { return row_of(map, hole).clearance_mm[0].value_or(-1.0); };
  EXPECT_NEAR(to_bone("B2"), 25.0 - radius, 1e-9);
  EXPECT_NEAR(to_bone("B3"), 15.0 - radius, 1e-9) << "10 mm further to anterior";
  EXPECT_NEAR(to_bone("A1"), 35.0 - radius, 1e-9);
  EXPECT_FALSE(row_of(map, "B2").clearance_mm[1]) << "this patient has no urethra";
  EXPECT_FALSE(row_of(map, "B2").clearance_mm[2]) << "and no rectum";
}

TEST(HoleMap, clearance_is_zero_where_the_way_goes_through) {
  TetMesh mesh = box_patient();
  mesh.regions.emplace_back("urethra");
  mesh.regions.emplace_back("rectum");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (const Index node : mesh.tets[t]) centre += 0.25 * mesh.nodes[static_cast<std::size_t>(node)];
    if (std::abs(centre.x()) < 10 && centre.y() > 0 && centre.y() < 10 && mesh.tet_region[t] == 1)
      mesh.tet_region[t] = 3;
    if (centre.y() > 20 && mesh.tet_region[t] == 0) mesh.tet_region[t] = 4;
  }
  const HoleMap map = ways_of(scenario_with_template(), mesh);
  EXPECT_EQ(row_of(map, "B2").clearance_mm[1], 0.0);
  EXPECT_GT(row_of(map, "B2").in_target_mm, 8.0) << "in the urethra it is in the gland as well";
  EXPECT_GT(row_of(map, "B2").clearance_mm[2].value_or(-1.0), 1.0);
  EXPECT_NEAR(row_of(map, "B1").clearance_mm[2].value_or(-1.0), 5.0 - 0.5 * 1.27, 1e-9) << "y = 15, rectum from 20 on";
}

TEST(HoleMap, says_what_a_hole_lacks_whose_target_is_out_of_reach) {
  Scenario s = scenario_with_template();
  s.grid.columns = {"A"};
  s.grid.rows = {"1"};
  s.insertions[0].hole = "A1";
  Scenario short_needle = s;
  short_needle.needle.length_mm = 40.0;
  short_needle.insertions[0].depth_mm = 30.0;
  const auto other = compiled(short_needle);
  InsertionPlan plan = short_needle.insertions[0];
  plan.depth_mm = 0.0;
  const auto map = map_ways(*other, through_each(plan), "case.toml");
  ASSERT_TRUE(map) << map.error().message();
  EXPECT_SAYS(row_of(*map, "A1").failed, "the needle is 40 mm long");
  HoleMap predicted = *map;
  predict_holes(other, through_each(plan), predicted);
  EXPECT_FALSE(row_of(predicted, "A1").prediction);
}

TEST(HoleMap, is_refused_where_it_has_no_sense) {
  TetMesh mesh = box_patient();
  mesh.regions[1] = "muscle";
  Scenario s = scenario_with_template();
  const auto no_target = compiled(s, mesh);
  const auto refused = map_ways(*no_target, through_each(s.insertions[0]), "case.toml");
  ASSERT_FALSE(refused);
  EXPECT_SAYS(refused.error().message(), "case.toml: the patient has no target");
  EXPECT_SAYS(refused.error().message(), "muscle");

  EXPECT_TRUE(check_mappable(s, "case.toml"));
  Scenario two = s;
  two.insertions.push_back(s.insertions[0]);
  EXPECT_SAYS(check_mappable(two, "case.toml").error().message(), "case.toml, [[insertion]]: there are 2 insertions");
  Scenario recorded = s;
  recorded.insertions[0].motion = "hand.csv";
  EXPECT_SAYS(check_mappable(recorded, "case.toml").error().message(), "insertion[0].motion = \"hand.csv\"");
  EXPECT_SAYS(check_mappable(box_scenario(), "case.toml").error().message(), "insertion[0].entry_mm");
  for (const Scenario& bad : {two, recorded, box_scenario()})
    EXPECT_EQ(check_mappable(bad, "case.toml").error().kind, ErrorKind::input);
}

TEST(HoleMap, refuses_a_template_none_of_whose_holes_leads_to_the_target) {
  Scenario s = scenario_with_template();
  s.grid.centre_mm = {25.0, 25.0};
  s.grid.pitch_mm = 1.0;
  const auto model = compiled(s);
  const auto map = map_ways(*model, through_each(s.insertions[0]), "case.toml");
  ASSERT_FALSE(map);
  EXPECT_SAYS(map.error().message(), "no hole of the template leads into the target");
  EXPECT_SAYS(map.error().message(), "template.centre_mm");
}

/// Compares with a tolerance, because insertions in parallel factorise with fewer threads, which changes the last bits.
void expect_near(const Vec3& a, const Vec3& b) { EXPECT_LT((a - b).norm(), 1e-9); }

TEST(HolePrediction, is_that_of_the_run_with_this_hole) {
  Scenario s = scenario_with_template();
  s.grid.rows = {"2"};
  s.grid.columns = {"B", "C"};
  s.insertions[0].speed_mm_per_s = 80.0;
  s.insertions[0].depth_mm = 30.0;
  const auto model = compiled(s);
  auto map = map_ways(*model, through_each(s.insertions[0]), "case.toml");
  ASSERT_TRUE(map);
  ASSERT_EQ(map->holes.size(), 2U);
  predict_holes(model, through_each(s.insertions[0]), *map);
  for (const HoleRow& row : map->holes) {
    ASSERT_TRUE(row.prediction) << row.failed;
    Scenario other = s;
    other.insertions[0].hole = row.hole;
    const Summary summary = Finished(compiled(other)).summary;
    ASSERT_TRUE(summary.gland && summary.tip_error_mm);
    EXPECT_EQ(row.prediction->shift_at_break_mm.has_value(), summary.gland->shift_at_break_mm.has_value());
    if (row.prediction->shift_at_break_mm)
      expect_near(*row.prediction->shift_at_break_mm, summary.gland->shift_at_break_mm.value_or(Vec3::Zero()));
    expect_near(row.prediction->shift_max_mm.value_or(Vec3::Zero()), summary.gland->shift_max_mm);
    expect_near(row.prediction->tip_error_mm.value_or(Vec3::Zero()), *summary.tip_error_mm);
  }
  EXPECT_NE(map->holes[0].prediction->tip_error_mm, map->holes[1].prediction->tip_error_mm) << "holes differ";
}

/// The template with needles in place to both sides of the middle.
Scenario scenario_beside_needles() {
  Scenario s = scenario_with_template();
  s.grid.rows = {"2"};
  s.grid.columns = {"A", "B", "C", "D"};
  s.grid.pitch_mm = 6.0;
  s.insertions[0].hole = "C2";
  s.insertions[0].speed_mm_per_s = 80.0;
  s.insertions[0].depth_mm = 30.0;
  s.procedure.stabilising = {"B2", "D2"};
  return s;
}

TEST(HoleMap, says_which_holes_needles_are_in_place_in_and_gives_no_figures_for_these) {
  const HoleMap map = ways_of(scenario_beside_needles());
  EXPECT_EQ(map.in_place, (std::vector<std::string>{"B2", "D2"}));
  for (const HoleRow& row : map.holes) {
    const bool taken = row.hole == "B2" || row.hole == "D2";
    EXPECT_EQ(!row.failed.empty(), taken) << row.hole;
    EXPECT_EQ(row.depth_mm > 0.0, !taken) << row.hole;
  }
  EXPECT_EQ(needles_in_place(map), nullptr) << "nothing is predicted yet";
}

TEST(HolePrediction, beside_needles_in_place_is_that_of_the_run_with_this_hole) {
  const Scenario s = scenario_beside_needles();
  const auto model = compiled(s);
  ASSERT_EQ(model->staying().size(), 2U);
  auto map = map_ways(*model, through_each(s.insertions[0]), "case.toml");
  ASSERT_TRUE(map);
  predict_holes(model, through_each(s.insertions[0]), *map);
  int predicted = 0;
  for (const HoleRow& row : map->holes) {
    if (row.hole == "B2" || row.hole == "D2") continue;
    ASSERT_TRUE(row.prediction && row.prediction->in_place) << row.failed;
    ++predicted;
    Scenario other = s;
    other.insertions[0].hole = row.hole;
    const Finished run(compiled(other));
    ASSERT_TRUE(run.summary.gland && run.summary.tip_error_mm && run.summary.in_place);
    const NeedlesInPlace& held = *row.prediction->in_place;
    const NeedlesInPlace& of_run = *run.summary.in_place;
    EXPECT_EQ(held.holes, s.procedure.stabilising);
    expect_near(row.prediction->shift_max_mm.value(), run.summary.gland->shift_max_mm);
    expect_near(row.prediction->tip_error_mm.value(), *run.summary.tip_error_mm);
    expect_near(held.shift_mm.value(), of_run.shift_mm.value());
    expect_near(held.shift_max_mm.value(), of_run.shift_max_mm.value());
    expect_near(held.tip_error_mm.value(), of_run.tip_error_mm.value());
    expect_near(effect_of(row).tip_error_mm.value(), held.tip_error_mm.value());
    // Time counts from the moment when the needles are in place, and their steps are not recorded.
    EXPECT_NEAR(run.kept.steps.front().time_s, 1e-3 * s.run.dt_ms, 1e-12);
  }
  EXPECT_EQ(predicted, 2);
  ASSERT_NE(needles_in_place(*map), nullptr);
  EXPECT_EQ(needles_in_place(*map)->holes, s.procedure.stabilising);
}

TEST(HolePrediction, without_needles_in_place_says_nothing_about_them) {
  Scenario s = scenario_beside_needles();
  s.procedure.stabilising.clear();
  const auto model = compiled(s);
  EXPECT_TRUE(model->staying().empty());
  KnownTargets targets;
  const auto alone = predict(model, targets);
  ASSERT_TRUE(alone);
  EXPECT_FALSE(alone->in_place);
}

TEST(KnownTargets, is_used_again_for_the_same_tissue_only) {
  const Scenario s = scenario_beside_needles();
  const auto model = compiled(s);
  const auto target = TargetMotion::of(*model);
  ASSERT_TRUE(target);
  EXPECT_TRUE(target->shared_with(*compiled(s)));
  Scenario softer = s;
  softer.tissue["prostate"] = tissue_of(s, "prostate");
  softer.tissue["prostate"].young_kPa *= 0.9;
  EXPECT_FALSE(target->shared_with(*compiled(softer)));
  Scenario free = s;
  free.fixed.outer = OuterSupport::none;
  EXPECT_FALSE(target->shared_with(*compiled(free)));
}

TEST(KnownTargets, does_not_change_a_run) {
  const auto model = compiled(scenario_beside_needles());
  KnownTargets targets;
  Kept alone, first, second;
  const auto expected = run(model, alone);
  const auto with = run(model, first, targets);
  const auto again = run(model, second, targets);
  ASSERT_TRUE(expected && with && again);
  EXPECT_EQ(again->target_shift_centroid_mm, expected->target_shift_centroid_mm);
  EXPECT_EQ(again->gland->shift_max_mm, expected->gland->shift_max_mm);
  EXPECT_EQ(with->target_shift_centroid_mm, expected->target_shift_centroid_mm);
}

// The two ways of counting differ by the motion of the tissue that the needles in place have caused: they have pushed
// the gland to superior, and the tip finds tissue from further inferior at the planned place.
TEST(NeedlesInPlace, hold_the_gland_where_they_have_pushed_it) {
  const Scenario s = scenario_beside_needles();
  KnownTargets targets;
  const auto beside = predict(compiled(s), targets);
  Scenario bare = s;
  bare.procedure.stabilising.clear();
  KnownTargets others;
  const auto alone = predict(compiled(bare), others);
  ASSERT_TRUE(beside && alone && beside->in_place);
  const NeedlesInPlace& held = *beside->in_place;
  EXPECT_GT(held.shift_mm.value().z(), 0.02) << "their friction and their tips push the gland";
  EXPECT_LT(held.shift_max_mm->norm(), 0.95 * alone->shift_max_mm->norm()) << "they hold it against the next needle";
  EXPECT_GT((*held.tip_error_mm - *beside->tip_error_mm).z(), 0.02) << "less of the error is left to this needle";
}

TEST(NeedlesInPlace, in_firm_tissue_make_no_difference_to_what_counts_from_the_plan) {
  Scenario s = scenario_beside_needles();
  for (const char* region : {"body", "prostate"}) {
    TissueParameters t = tissue_of(s, region);
    t.young_kPa *= 1000.0;
    s.tissue[region] = t;
  }
  KnownTargets targets;
  const auto beside = predict(compiled(s), targets);
  ASSERT_TRUE(beside && beside->in_place);
  EXPECT_LT(beside->in_place->shift_mm->norm(), 0.01);
  EXPECT_LT((*beside->in_place->tip_error_mm - *beside->tip_error_mm).norm(), 0.05);
}

TEST(NeedlesInPlace, and_an_insertion_through_the_same_hole_are_refused) {
  Scenario s = scenario_beside_needles();
  s.insertions[0].hole = "B2";
  const auto refusal = check_scenario(s, "case.toml");
  ASSERT_FALSE(refusal);
  EXPECT_SAYS(refusal.error().message(), "insertion[0].hole = \"B2\" is taken");
  s.insertions[0].hole = "C2";
  s.procedure.stabilising = {"Z9"};
  EXPECT_SAYS(check_scenario(s, "case.toml").error().message(), "procedure.stabilising names \"Z9\"");
}

// A recording of a run with needles in place is repeated with them in place.
TEST(NeedlesInPlace, are_in_place_when_a_recording_is_repeated) {
  const auto model = compiled(scenario_beside_needles());
  const Finished run(model);
  const std::vector<Step>& steps = run.kept.steps;
  Kept again;
  ASSERT_TRUE(run_recorded(model, steps, again));
  ASSERT_EQ(again.steps.size(), steps.size());
  for (std::size_t k = 0; k < steps.size(); ++k) EXPECT_EQ(again.steps[k].hand_force_N, steps[k].hand_force_N) << k;
}

TEST(TipError, is_what_the_deepest_point_of_the_track_lies_off_the_plan) {
  // In very stiff tissue the needle reaches the planned point.
  Scenario soft = scenario_with_template();
  Scenario firm = soft;
  for (const char* region : {"body", "prostate"}) {
    TissueParameters t = tissue_of(firm, region);
    t.young_kPa *= 100.0;
    firm.tissue[region] = t;
  }
  const Finished in_soft(compiled(soft));
  const Finished in_firm(compiled(firm));
  ASSERT_TRUE(in_soft.summary.tip_error_mm && in_firm.summary.tip_error_mm);
  EXPECT_LT(in_soft.summary.tip_error_mm->z(), -0.5) << "what is pushed away is not reached";
  EXPECT_LT(in_firm.summary.tip_error_mm->norm(), 0.1 * in_soft.summary.tip_error_mm->norm());
}

}  // namespace
}  // namespace stylet
