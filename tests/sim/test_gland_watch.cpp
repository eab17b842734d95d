// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_patient.hpp"
#include "stylet/sim/far_gland.hpp"
#include "stylet/sim/gland_watch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A run of the box patient in linear elastic tissue, where frames and the gland's path give the same motion.
const Finished& box_run() {
  static const Finished run = [] {
    Scenario s = box_scenario();
    s.tissue_model.preset = TissuePreset::linear;
    return Finished(compiled(s));
  }();
  return run;
}

Step at_time(double time_s) {
  Step step;
  step.time_s = time_s;
  step.base_depth_mm = 10.0 * time_s;
  return step;
}

VolumeMotion moved(double superior_mm) {
  VolumeMotion motion;
  motion.shift_mm = {0.0, 0.0, superior_mm};
  motion.rotation_rad = {0.1 * superior_mm, 0.2 * superior_mm, 0.3 * superior_mm};
  motion.third_mm[VolumeMotion::superior] = {0.0, 0.0, 1.5 * superior_mm};
  motion.dilation = 0.01 * superior_mm;
  return motion;
}

/// Result after steps of 0.1 s with these shifts and events; the needle is deepest after step number `deepest`.
GlandMotion told(const std::vector<double>& shifts, const std::vector<std::pair<std::size_t, Event>>& events,
                 std::size_t deepest, bool at_rest) {
  GlandWatch watch({"peripheral_zone", "transition_zone"});
  for (std::size_t k = 0; k < shifts.size(); ++k) {
    std::vector<Event> now;
    for (const auto& [step, event] : events) {
      if (step == k) now.push_back(event);
    }
    watch.add(at_time(0.1 * static_cast<double>(k)), now, moved(shifts[k]), at_rest, k == deepest);
  }
  return watch.result();
}

Event event(EventKind kind, double time_s, const std::string& region = {}) { return {kind, time_s, 0.0, 0.0, region}; }

TEST(GlandWatch, the_break_is_that_of_the_gland_s_surface_and_told_as_before_it) {
  const GlandMotion motion = told({0.1, 0.2, 0.5, 0.3, 0.4},
                                  {{1, event(EventKind::puncture, 0.1, "body")},
                                   {3, event(EventKind::puncture, 0.3, "transition_zone")},
                                   {4, event(EventKind::puncture, 0.4, "peripheral_zone")}},
                                  4, false);
  ASSERT_TRUE(motion.shift_at_break_mm);
  EXPECT_EQ(motion.shift_at_break_mm->z(), 0.5);
  EXPECT_FALSE(told({0.1, 0.2}, {{1, event(EventKind::puncture, 0.1, "body")}}, 1, false).shift_at_break_mm);
}

TEST(GlandWatch, the_largest_shift_is_that_of_the_way_in_and_brings_all_else_of_its_moment) {
  const GlandMotion motion = told({0.1, -0.6, 0.3, -2.0}, {}, 2, false);
  EXPECT_EQ(motion.shift_max_mm.z(), -0.6);
  EXPECT_EQ(motion.shift_in_place_mm.z(), 0.3) << "what follows is the way out";
  EXPECT_NEAR(motion.rotation_deg.y(), -0.12 * 180.0 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(motion.base_mm.z(), -0.9, 1e-12);
  EXPECT_NEAR(motion.volume_change_percent, -0.6, 1e-12);
}

TEST(GlandWatch, what_is_left_is_asked_for_a_second_after_the_needle_is_out) {
  std::vector<double> shifts(14);
  for (std::size_t k = 0; k < shifts.size(); ++k) shifts[k] = 0.01 * static_cast<double>(k);
  const auto out = std::pair{std::size_t{2}, event(EventKind::withdrawn, 0.2)};
  ASSERT_TRUE(told(shifts, {out}, 1, false).shift_residual_mm);
  EXPECT_NEAR(told(shifts, {out}, 1, false).shift_residual_mm->z(), 0.12, 1e-12);
  shifts.resize(8);
  EXPECT_FALSE(told(shifts, {out}, 1, false).shift_residual_mm) << "the run ends before";
  ASSERT_TRUE(told(shifts, {out}, 1, true).shift_residual_mm) << "nothing acts on the tissue any more";
  EXPECT_TRUE(told(shifts, {out}, 1, true).shift_residual_mm->isZero(0.0));
  EXPECT_FALSE(told(shifts, {}, 1, true).shift_residual_mm) << "the needle is still in";
}

VolumeMotion turned(double degrees, double posterior_mm) {
  VolumeMotion motion;
  motion.rotation_rad = degrees * std::numbers::pi / 180.0 * Vec3(0.6, 0.0, -0.8);
  motion.shift_mm = {0.0, posterior_mm, 0.0};
  return motion;
}

TEST(FarGland, within_what_glands_do_is_no_warning) {
  FarGland far;
  far.add(at_time(1.0), turned(14.0, -20.0));
  EXPECT_EQ(far.warning(), std::nullopt);
}

TEST(FarGland, beyond_that_is_told_at_its_furthest_with_the_depth) {
  FarGland turn;
  for (const double degrees : {4.0, 21.4, 17.0}) turn.add(at_time(degrees), turned(degrees, 3.0));
  ASSERT_TRUE(turn.warning());
  EXPECT_NE(turn.warning()->find("turned by 21° when the needle's base was 214.0 mm deep"), std::string::npos)
      << *turn.warning();
  EXPECT_EQ(turn.warning()->find("moved"), std::string::npos) << *turn.warning();

  FarGland shift;
  for (const double mm : {24.0, -26.0, 3.0}) shift.add(at_time(std::abs(mm)), turned(0.0, mm));
  ASSERT_TRUE(shift.warning());
  EXPECT_NE(shift.warning()->find("moved by 26 mm when the needle's base was 260.0 mm deep"), std::string::npos)
      << *shift.warning();
  EXPECT_EQ(shift.warning()->find("turned"), std::string::npos) << *shift.warning();
}

TEST(GlandMotion, turns_are_told_by_where_the_gland_goes) {
  const auto turned = [](const Vec3& rotation_deg, const Vec3& at) -> Vec3 { return rotation_deg.cross(at); };
  EXPECT_GT(turned(rotation_of({.coronal = 1.0}), Vec3::UnitZ()).x(), 0.0) << "base to the left";
  EXPECT_LT(turned(rotation_of({.sagittal = 1.0}), Vec3::UnitZ()).y(), 0.0) << "base to anterior";
  EXPECT_GT(turned(rotation_of({.transverse = 1.0}), Vec3::UnitX()).y(), 0.0) << "left side to posterior";
  GlandMotion motion;
  motion.rotation_deg = rotation_of({1.0, -2.0, 3.0});
  const auto turns = named_turns(motion);
  EXPECT_EQ(turns[0].direction, "base to the left");
  EXPECT_EQ(turns[1].direction, "base to posterior");
  EXPECT_EQ(turns[2].direction, "left side to posterior");
}

/// Mean of a frame's displacement over the target, with linear elements.
Vec3 mean_shift(const TetMesh& mesh, const std::vector<int>& target, const VecX& u) {
  Vec3 sum = Vec3::Zero();
  double volume = 0.0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    if (std::find(target.begin(), target.end(), mesh.tet_region[static_cast<std::size_t>(t)]) == target.end()) continue;
    for (const Index node : mesh.tets[static_cast<std::size_t>(t)])
      sum += 0.25 * tet_volume(mesh, t) * u.segment<3>(3 * Eigen::Index{node});
    volume += tet_volume(mesh, t);
  }
  return sum / volume;
}

TEST(GlandOfARun, is_where_the_frames_show_it) {
  const Finished& r = box_run();
  ASSERT_EQ(r.summary.gland_path.size(), r.kept.steps.size());
  for (const Frame& frame : r.kept.frames) {
    const auto step =
        std::find_if(r.kept.steps.begin(), r.kept.steps.end(), [&](const Step& s) { return s.time_s == frame.time_s; });
    if (step == r.kept.steps.end()) continue;
    const GlandStep& gland = r.summary.gland_path[static_cast<std::size_t>(step - r.kept.steps.begin())];
    EXPECT_EQ(gland.time_s, frame.time_s);
    EXPECT_EQ(gland.base_depth_mm, frame.base_depth_mm);
    const Vec3 shown = mean_shift(r.model->mesh(), r.model->target_regions(), frame.displacement);
    EXPECT_LT((gland.shift_mm - shown).norm(), 0.3 * shown.norm() + 0.01) << frame.label << " at " << frame.time_s;
  }
}

TEST(GlandOfARun, is_told_from_its_path) {
  const Finished& r = box_run();
  const auto& path = r.summary.gland_path;
  ASSERT_TRUE(r.summary.gland);
  const GlandMotion& gland = *r.summary.gland;
  ASSERT_EQ(r.summary.gland_motions.size(), 1U);
  EXPECT_EQ(gland.shift_in_place_mm, r.summary.target_shift_centroid_mm);
  double largest = 0.0;
  for (const GlandStep& step : path) {
    if (step.time_s <= r.event(EventKind::retraction_start)->time_s) largest = std::max(largest, step.shift_mm.norm());
  }
  EXPECT_EQ(gland.shift_max_mm.norm(), largest);
  const Event* puncture = r.event(EventKind::puncture, "prostate");
  ASSERT_NE(puncture, nullptr);
  ASSERT_TRUE(gland.shift_at_break_mm);
  const auto broken =
      std::find_if(path.begin(), path.end(), [&](const GlandStep& s) { return s.time_s == puncture->time_s; });
  ASSERT_TRUE(broken != path.end() && broken != path.begin());
  EXPECT_EQ(*gland.shift_at_break_mm, std::prev(broken)->shift_mm);
  ASSERT_TRUE(gland.shift_residual_mm) << "elastic tissue is back at once";
  EXPECT_TRUE(gland.shift_residual_mm->isZero(0.0));
  EXPECT_TRUE(path.back().shift_mm.isZero(0.0));
  EXPECT_GT(gland.shift_max_mm.z(), 0.0);
  EXPECT_TRUE(gland.base_mm.allFinite() && gland.mid_mm.allFinite() && gland.apex_mm.allFinite());
  EXPECT_LT(std::abs(gland.volume_change_percent), 5.0);
}

TEST(GlandOfARun, that_creeps_tells_what_is_left_a_second_after_the_needle_is_out) {
  Scenario s = box_scenario();
  s.tissue_model.creep = 3.0;
  s.tissue_model.creep_s = 0.5;
  const Finished r(compiled(s));
  ASSERT_TRUE(r.summary.gland);
  ASSERT_NE(r.event(EventKind::withdrawn), nullptr);
  ASSERT_TRUE(r.summary.gland->shift_residual_mm);
  const double left = r.summary.gland->shift_residual_mm->norm();
  EXPECT_GT(left, 0.0);
  EXPECT_LT(left, 0.2 * r.summary.gland->shift_in_place_mm.norm());
}

}  // namespace
