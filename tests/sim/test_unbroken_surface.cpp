// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_patient.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet {
namespace {

using test::box_scenario;
using test::compiled;

/// All warnings of a complete insertion.
std::string warnings_of(const Scenario& scenario) {
  struct Nobody : RunObserver {
    Result<> on_step(const Step&) override { return Ok{}; }
    Result<> on_frame(const Frame&) override { return Ok{}; }
  } nobody;
  const auto done = run(compiled(scenario), nobody);
  EXPECT_TRUE(done.ok());
  std::string all;
  if (done) {
    for (const std::string& warning : done->warnings) all += warning + '\n';
  }
  return all;
}

/// [N] The force of the tip that a warning tells; NaN: it tells none.
double told_N(const std::string& said) {
  const std::string before = "mm inwards with up to ";
  const auto at = said.find(before);
  return at == std::string::npos ? std::nan("") : std::stod(said.substr(at + before.size()));
}

Scenario with(const std::string& region, double puncture_N) {
  Scenario s = box_scenario();
  TissueParameters p = default_tissue(region);
  p.puncture_N = puncture_N;
  s.tissue[region] = p;
  return s;
}

TEST(UnbrokenSurface, a_capsule_that_is_pressed_far_in_and_never_breaks_is_told_of) {
  const std::string said = warnings_of(with("prostate", 50.0));
  EXPECT_SAYS(said, "pressed the surface of the prostate");
  EXPECT_SAYS(said, "but 50.00 N are needed to break it");
  EXPECT_SAYS(said, "Lower tissue.prostate.puncture_N");
}

TEST(UnbrokenSurface, skin_that_never_breaks_is_told_of_too) {
  EXPECT_SAYS(warnings_of(with("body", 50.0)), "pressed the surface of the body");
}

TEST(UnbrokenSurface, the_force_that_holds_is_named_where_it_is_that_of_cutting) {
  Scenario s = with("body", 2.8);
  s.tissue["body"].cutting_N = 50.0;
  const std::string of_skin = warnings_of(s);
  EXPECT_SAYS(of_skin, "but 50.00 N are needed to cut into the tissue behind it (tissue.body.cutting_N");
  EXPECT_SAYS(of_skin, "Lower tissue.body.cutting_N");
  s = with("prostate", 1.0);
  s.tissue["prostate"].cutting_N = 50.0;
  EXPECT_SAYS(warnings_of(s), "Lower tissue.prostate.cutting_N");
}

TEST(UnbrokenSurface, nothing_is_said_of_surfaces_that_break) {
  EXPECT_FALSE(test::contains(warnings_of(box_scenario()), "The tip pressed"));
}

/// The tip stops wherever its depth is reached, mostly while it presses the tissue that it has dragged along.
TEST(UnbrokenSurface, nothing_is_said_of_soft_tissue_that_a_needle_drags_along_while_it_cuts_it) {
  Scenario s = with("body", 0.3);
  for (const char* region : {"body", "prostate"}) {
    TissueParameters& p = s.tissue.try_emplace(region, default_tissue(region)).first->second;
    p.young_kPa = 3.0;
    p.puncture_N = 0.3;
    p.cutting_N = 0.6;
    p.friction_coulomb_N_per_m *= 3.0;
    p.friction_static_N_per_m *= 3.0;
  }
  for (const double depth_mm : {30.0, 42.0}) {
    s.insertions[0].depth_mm = depth_mm;
    s.insertions[0].retract = false;
    const std::string said = warnings_of(s);
    EXPECT_FALSE(test::contains(said, "did not go on")) << depth_mm << ": " << said;
  }
}

/// Euler's load of a needle that the hand clamps and the skin holds: 2.05 π² E I / L².
TEST(UnbrokenSurface, a_thin_needle_that_bows_out_on_the_skin_is_told_of_with_the_load_under_which_it_buckles) {
  Scenario s = box_scenario();
  s.needle.diameter_mm = 0.51;
  s.needle.lumen_diameter_mm = 0.26;
  s.insertions[0].depth_mm = 30.0;
  const double inertia = std::numbers::pi / 64.0 * (std::pow(0.51, 4) - std::pow(0.26, 4));
  const double euler_N = 2.05 * std::pow(std::numbers::pi / s.needle.length_mm, 2) * 200e3 * inertia;
  const std::string said = warnings_of(s);
  EXPECT_SAYS(said, "The needle bowed out under ");
  EXPECT_SAYS(said, "instead of breaking the surface of the body");
  const double told_N = std::stod(said.substr(said.find("bowed out under ") + 16));
  EXPECT_GT(told_N, euler_N);
  EXPECT_LT(told_N, 1.2 * euler_N);
  EXPECT_FALSE(test::contains(said, "no balance"));
}

/// Pushed on, it bows until its tip lies flat on the skin. From then on it has no force, and that is said once instead
/// of in every step.
TEST(UnbrokenSurface, a_needle_that_has_bowed_flat_slides_off_and_is_told_of) {
  Scenario s = box_scenario();
  s.needle.diameter_mm = 0.51;
  s.needle.lumen_diameter_mm = 0.26;
  s.insertions[0].depth_mm = 100.0;
  test::Kept kept;
  const auto done = run(compiled(s), kept);
  ASSERT_TRUE(done.ok());
  std::string said;
  for (const std::string& warning : done->warnings) said += warning + '\n';
  EXPECT_SAYS(said, "buckled");
  EXPECT_SAYS(said, "its tip lay flat on the surface and slid off it");
  const double slid_off_mm = std::stod(said.substr(said.find("At a base depth of ") + 19));
  double most_N = 0.0;
  for (const Step& step : kept.steps) {
    EXPECT_EQ(step.flags, 0U) << step.time_s << " s";
    const bool is_beyond = step.base_depth_mm > slid_off_mm + 1.0;
    if (is_beyond) EXPECT_EQ(step.hand_force_N.norm(), 0.0) << step.base_depth_mm << " mm";
    most_N = std::max(most_N, step.hand_force_N.norm());
  }
  EXPECT_GT(most_N, 0.1);
  EXPECT_EQ(kept.steps.back().tip_state, TipState::air);
}

/// In tissue that has crept, too: a force above that of the hand would be none that the surface has borne.
TEST(UnbrokenSurface, the_force_told_is_that_of_the_tip_however_long_the_needle_rests) {
  Scenario s = with("prostate", 50.0);
  s.insertions[0].dwell_s = 2.0;
  const test::Finished done(compiled(s));
  double most_N = 0.0;
  for (const Step& step : done.kept.steps) most_N = std::max(most_N, step.force_axial_N);
  std::string said;
  for (const std::string& warning : done.summary.warnings) said += warning + '\n';
  EXPECT_GT(told_N(said), 0.3 * most_N);
  EXPECT_LT(told_N(said), most_N);
}

/// A tip that is bent aside bears more along the hand's direction than along itself, and the latter breaks a surface.
TEST(UnbrokenSurface, the_force_told_of_a_needle_that_bows_is_the_one_that_decides) {
  Scenario s = with("body", 50.0);
  s.tissue["body"].young_kPa = 8.0;
  s.needle.diameter_mm = 0.908;
  s.needle.lumen_diameter_mm = 0.603;
  s.needle.length_mm = 200.0;
  s.insertions[0].direction = {0.2, -0.25, 1.0};
  s.insertions[0].entry_mm = {-4.0, 12.0, 0.0};
  s.insertions[0].depth_mm = 45.0;
  s.insertions[0].retract = false;
  const double reached_N = told_N(warnings_of(s));
  ASSERT_GT(reached_N, 0.0);
  const auto said = [&](double share) {
    s.tissue["body"].puncture_N = share * reached_N;
    return warnings_of(s);
  };
  EXPECT_SAYS(said(1.02), "did not enter the body");
  EXPECT_FALSE(test::contains(said(0.98), "did not enter the body")) << reached_N;
}

/// The force that the tip reaches at the deepest point decides whether a capsule breaks: one that is a little stronger
/// or weaker is a close call, and one that is much stronger or weaker is none.
TEST(UnbrokenSurface, a_capsule_that_was_about_to_break_or_broke_at_the_last_moment_is_told_of) {
  Scenario s = with("prostate", 50.0);
  s.insertions[0].depth_mm = 28.0;
  const double reached_N = told_N(warnings_of(s));
  ASSERT_GT(reached_N, 0.0);
  const auto said = [&](double share) {
    s.tissue["prostate"].puncture_N = share * reached_N;
    return warnings_of(s);
  };
  const std::string may_enter = "With another time step or mesh the needle may enter the prostate";
  const std::string may_stay = "With another time step or mesh the needle may stay outside the prostate";
  EXPECT_FALSE(test::contains(said(1.2), "With another"));
  EXPECT_SAYS(said(1.04), may_enter);
  EXPECT_SAYS(said(0.98), may_stay);
  EXPECT_FALSE(test::contains(said(0.98), may_enter));
  EXPECT_FALSE(test::contains(said(0.8), "With another"));
}

/// The distance in the warning is the distance of the tip past the rest position of the surface.
TEST(UnbrokenSurface, the_way_is_no_longer_than_the_base_went_in) {
  Scenario s = with("body", 50.0);
  s.insertions[0].depth_mm = 9.0;
  EXPECT_FALSE(test::contains(warnings_of(s), "The tip pressed"));
  s.insertions[0].depth_mm = 12.0;
  EXPECT_SAYS(warnings_of(s), "pressed the surface of the body 1");
}

/// The tissue that the tip has pushed ahead springs back at once, so that with a long step much is cut in one piece.
/// Its direction is that of the tissue behind the surface: the soft tissue before it was squeezed, and leads aside.
TEST(UnbrokenSurface, the_track_behind_a_capsule_in_fat_does_not_depend_on_the_time_step) {
  TetMesh mesh = box_mesh({-30, -30, 0}, {30, 30, 60}, {10, 10, 10});
  assign_regions(mesh, {"body", "prostate", "periprostatic_fat"}, [](const Vec3& x) {
    const double off = (x - Vec3(0, 5, 32)).norm();
    return off < 16.0 ? 1 : off < 23.0 ? 2 : 0;
  });
  std::vector<Vec3> tips;
  for (const double dt_ms : {0.5, 4.0}) {
    Scenario s = box_scenario();
    s.insertions[0].depth_mm = 45.0;
    s.insertions[0].retract = false;
    s.needle.bevel_deg = 20.0;
    s.run.dt_ms = dt_ms;
    const test::Finished done(compiled(s, mesh));
    EXPECT_NE(done.event(EventKind::puncture, "prostate"), nullptr);
    tips.push_back(done.kept.steps.back().tip_mm);
  }
  EXPECT_LT((tips[0] - tips[1]).norm(), 0.3) << (tips[1] - tips[0]).transpose();
}

}  // namespace
}  // namespace stylet
