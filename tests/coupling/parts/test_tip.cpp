// SPDX-License-Identifier: GPL-3.0-or-later
// The tip and its track, without the other parts of an insertion.
#include "coupling/parts/simple_tissue.hpp"
#include "coupling/tip/tip_path.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

using test::SimpleTissue;

std::vector<EventKind> kinds(const TipPath& path) {
  std::vector<EventKind> result;
  for (const InsertionEvent& event : path.events.all()) result.push_back(event.kind);
  return result;
}

TEST(Cut, goes_where_it_is_aimed_and_stops_at_a_surface) {
  SimpleTissue block;
  Cut cut(*block.locator, *block.tissue);
  const Vec3 from(1, 2, 18.5);
  cut.put(from, block.at(from));
  cut.aim(Vec3::UnitZ());
  cut.march(1.0);
  EXPECT_FALSE(cut.is_blocked());
  EXPECT_NEAR((cut.x() - Vec3(1, 2, 19.5)).norm(), 0.0, 1e-12);
  cut.march(3.0);
  EXPECT_TRUE(cut.is_blocked()) << "the organ begins at 20 mm";
  EXPECT_NEAR(cut.x().z(), 20.0, 1e-12);
  EXPECT_NEAR(cut.advance(), 1.5, 1e-12);
  cut.march_before_surface(3.0);
  EXPECT_EQ(cut.advance(), 0.0) << "rather nothing than up to the surface";
}

TEST(Cut, counts_its_way_from_where_the_sub_step_began) {
  SimpleTissue block;
  Cut cut(*block.locator, *block.tissue);
  cut.put(Vec3(1, 2, 5), block.at(Vec3(1, 2, 5)));
  cut.aim(Vec3::UnitZ());
  cut.march(0.4);
  cut.march(0.3);
  EXPECT_NEAR(cut.x().z(), 5.3, 1e-12) << "iterates do not add up";
  cut.begin();
  cut.march(0.3);
  EXPECT_NEAR(cut.x().z(), 5.6, 1e-12);
}

TEST(Cut, has_legs_each_with_a_direction_of_its_own) {
  SimpleTissue block;
  Cut cut(*block.locator, *block.tissue);
  cut.put(Vec3(1, 2, 5), block.at(Vec3(1, 2, 5)));
  double before = 0.0;
  Vec3 end(1, 2, 5);
  const double whole = 2.5;
  int legs = 0;
  for (; legs < 20; ++legs) {
    const Vec3 along = Vec3(0.1 * legs, -0.05 * legs, 1.0).normalized();
    cut.aim(along);
    cut.march_in_leg(whole);
    end += (cut.advance() - before) * along;
    EXPECT_NEAR((cut.x() - end).norm(), 0.0, 1e-12);
    EXPECT_EQ(cut.start().advance, before);
    if (!cut.ends_leg()) break;
    before = cut.advance();
    cut.begin_leg();
  }
  EXPECT_GT(legs, 3);
  EXPECT_NEAR(cut.advance(), whole, 1e-12);
  cut.march(0.0);
  EXPECT_NEAR(cut.advance(), before, 1e-12) << "iterates go back to the start of the leg, and no further";
  cut.take_back();
  EXPECT_EQ(cut.x(), Vec3(1, 2, 5));
  EXPECT_EQ(cut.advance(), 0.0);
}

TEST(Cut, in_a_leg_stops_at_a_surface) {
  SimpleTissue block;
  Cut cut(*block.locator, *block.tissue);
  cut.put(Vec3(1, 2, 19.9), block.at(Vec3(1, 2, 19.9)));
  cut.aim(Vec3::UnitZ());
  cut.march_in_leg(3.0);
  EXPECT_TRUE(cut.is_blocked()) << "the organ begins at 20 mm";
  EXPECT_FALSE(cut.ends_leg());
}

TEST(Cut, tells_that_compliances_of_another_place_stand_in) {
  SimpleTissue block;
  Cut cut(*block.locator, *block.tissue);
  block.compliance->has_all = false;
  cut.put(Vec3(1, 2, 5), block.at(Vec3(1, 2, 5)));
  EXPECT_TRUE(cut.is_stale());
  block.compliance->has_all = true;
  cut.take_compliance();
  EXPECT_FALSE(cut.is_stale());
}

TEST(CuttingLaw, its_force_and_its_way_are_inverses_and_nothing_is_cut_at_its_start) {
  const CuttingLaw law{.start_N = 0.25, .slip_mm_per_N = 3.0};
  EXPECT_EQ(law.way(0.25), 0.0);
  EXPECT_LT(law.way(0.2), 0.0) << "too little to cut";
  for (const double way : {-0.1, 0.0, 0.004, 1.7}) EXPECT_NEAR(law.way(law.force(way)), way, 1e-12);
}

TEST(Resistance, of_the_skin_gives_above_its_limit_to_a_tip_that_is_not_flat) {
  Resistance ahead;
  ahead.be_outer_surface(3, 1, Vec3::UnitZ(), 1.0, 0.3);
  EXPECT_FALSE(ahead.gives(0.99, Vec3::UnitZ(), 0.17));
  EXPECT_TRUE(ahead.gives(1.01, Vec3::UnitZ(), 0.17));
  EXPECT_FALSE(ahead.gives(5.0, Vec3(1.0, 0.0, 0.1).normalized(), 0.17)) << "flat to the skin";
  ahead.be_surface(4, 1.0);
  EXPECT_TRUE(ahead.gives(1.01, Vec3(1.0, 0.0, 0.1).normalized(), 0.17)) << "a wall within the patient";
  ahead.be_tissue(1, 0.2);
  EXPECT_FALSE(ahead.gives(5.0, Vec3::UnitZ(), 0.17)) << "tissue is cut, it does not break";
}

TEST(Resistance, of_skin_that_is_weaker_than_the_tissue_behind_it_is_that_of_the_tissue) {
  Resistance ahead;
  ahead.be_outer_surface(3, 1, Vec3::UnitZ(), 0.1, 0.3);
  EXPECT_EQ(ahead.limit(), 0.3);
}

TEST(Tracks, join_an_earlier_one_that_begins_nearby_in_the_same_direction) {
  Tracks tracks(10, 1.27);
  ASSERT_FALSE(tracks.begin(Vec3::Zero(), Vec3::UnitZ()));
  tracks.now.end_xi = 30.0;
  tracks.finish();
  EXPECT_TRUE(tracks.begin(Vec3(1.0, 0, 0), Vec3::UnitZ()));
  tracks.finish();
  EXPECT_EQ(tracks.earlier().size(), 1u) << "it took the place of the one it ran in";
  EXPECT_FALSE(tracks.begin(Vec3(2.0, 0, 0), Vec3::UnitZ())) << "beside it";
  tracks.now.end_xi = 5.0;
  tracks.finish();
  EXPECT_FALSE(tracks.begin(Vec3::Zero(), Vec3(1, 0, 1).normalized())) << "another direction";
}

TEST(Tracks, begin_a_joined_one_at_the_new_crossing_and_keep_the_old_entry) {
  Tracks tracks(10, 1.27);
  tracks.begin(Vec3::Zero(), Vec3::UnitZ());
  tracks.now.end_xi = 30.0;
  tracks.now.marks = {{0.5, Vec3(0, 0, 0.5), {}, 0, 1}, {10.0, Vec3(0, 0, 10), {}, 0, 2}};
  tracks.finish();
  ASSERT_TRUE(tracks.begin(Vec3(0.5, 0, 1.0), Vec3::UnitZ()));  // the skin is 1 mm deeper there
  EXPECT_EQ(tracks.now.end_xi, 29.0);
  ASSERT_EQ(tracks.now.marks.size(), 1u) << "the other one is before the skin";
  EXPECT_EQ(tracks.now.marks[0].xi, 9.0);
  EXPECT_EQ(tracks.now.marks[0].point, -1) << "the tissue model has forgotten it";
  tracks.finish();
  EXPECT_EQ(tracks.earlier()[0].entry, Vec3::Zero());
  EXPECT_EQ(tracks.earlier()[0].end_xi, 30.0);
}

TEST(Tracks, are_forgotten_without_length_and_the_oldest_where_there_is_no_room) {
  Tracks tracks(10, 1.27);
  tracks.begin(Vec3::Zero(), Vec3::UnitZ());
  tracks.finish();
  EXPECT_TRUE(tracks.earlier().empty()) << "the skin was only touched";
  for (int k = 0; k <= Tracks::kRoom; ++k) {
    tracks.begin(Vec3(5.0 * k, 0, 0), Vec3::UnitZ());
    tracks.now.end_xi = 10.0;
    tracks.finish();
  }
  ASSERT_EQ(tracks.earlier().size(), static_cast<std::size_t>(Tracks::kRoom));
  EXPECT_EQ(tracks.earlier().front().entry.x(), 5.0);
}

/// A tip that is moved by hand, without a balance.
class TipOnItsWay : public testing::Test {
 protected:
  TipOnItsWay() : path(block.insertion, block.settings, block.needle.base(), block.needle, *block.tissue) {
    block.put_tip(Vec3(1, 2, -1));
    path.place_in_air(path.tip_now());
  }
  void meet_skin() {
    block.put_tip(Vec3(1, 2, 0.2));
    ASSERT_TRUE(path.move_through_air(report));
  }
  /// Leaves the tip in the state in which a balance leaves a tip that cuts.
  void cut(double mm) {
    path.tip.set_state(TipContact::State::cut);
    path.tip.begin({path.tip.force, {}});
    path.tip.cut.march(mm);
    if (path.tip.cut.is_blocked()) path.tip.set_state(TipContact::State::stick);
    path.commit(report);
  }

  SimpleTissue block;
  TipPath path;
  Step report;
};

TEST_F(TipOnItsWay, presses_on_the_skin_it_meets) {
  EXPECT_TRUE(path.in_air());
  meet_skin();
  EXPECT_EQ(path.phase(), TipState::pressing);
  EXPECT_EQ(kinds(path), std::vector{EventKind::skin_contact});
  EXPECT_TRUE(path.tip.holds());
  EXPECT_NEAR(path.tip.cut.x().z(), 0.0, 1e-12);
  EXPECT_EQ(path.tip.ahead.limit(), 1.0);
  EXPECT_EQ(block.compliance->forced, 1);
}

TEST_F(TipOnItsWay, does_not_enter_where_no_compliance_is_there) {
  block.compliance->has_all = false;
  block.put_tip(Vec3(1, 2, 0.2));
  EXPECT_FALSE(path.move_through_air(report));
  EXPECT_TRUE(path.in_air());
  EXPECT_TRUE(path.awaits_entry());
  EXPECT_NE(report.flags & Step::compliance_missing, 0u);
  EXPECT_NEAR(path.whereabouts().tip.z(), 0.0, 1e-12) << "that is where it is needed";
}

TEST_F(TipOnItsWay, grazes_a_surface_that_it_meets_flat) {
  const Vec3 axis = Vec3(1.0, 0.0, 0.1).normalized();
  block.put_tip(Vec3(0, 2, -0.1), axis);
  path.place_in_air(path.tip_now());
  block.put_tip(Vec3(2, 2, 0.1), axis);
  EXPECT_TRUE(path.move_through_air(report));
  EXPECT_TRUE(path.in_air());
  EXPECT_EQ(kinds(path), std::vector{EventKind::grazed});
}

TEST_F(TipOnItsWay, breaks_the_skin_and_cuts_on_behind_it) {
  meet_skin();
  path.tip.force = Vec3(0, 0, 0.9);
  EXPECT_FALSE(path.tip.breaks_surface());
  path.tip.force = Vec3(0, 0, 1.1);
  ASSERT_TRUE(path.tip.breaks_surface());
  path.break_surface(1.05, report);
  EXPECT_EQ(kinds(path), (std::vector{EventKind::skin_contact, EventKind::puncture, EventKind::region_entered}));
  EXPECT_EQ(path.events.all()[1].force_N, 1.05);
  EXPECT_EQ(path.tip.ahead.cutting(), 0.3);
  const double h = 1e-3, speed_mm_per_s = 20.0;
  EXPECT_NEAR(path.tip.cutting_law(h).force(speed_mm_per_s * h),
              0.3 + block.settings.tip_viscosity_Ns_per_mm * speed_mm_per_s, 1e-12);
  cut(2.0);
  EXPECT_EQ(path.phase(), TipState::cutting);
  EXPECT_NEAR(path.tracks.now.end_xi, 2.0, 1e-12);
}

TEST_F(TipOnItsWay, stops_at_the_organs_capsule_and_lays_marks_before_it) {
  meet_skin();
  path.break_surface(1.0, report);
  for (int k = 0; k < 12; ++k) cut(2.0);
  EXPECT_NEAR(path.tip.cut.x().z(), 20.0, 1e-12);
  EXPECT_EQ(path.phase(), TipState::pressing);
  EXPECT_EQ(path.tip.ahead.limit(), 0.8) << "the stronger membrane";
  const auto& marks = path.tracks.now.marks;
  ASSERT_EQ(marks.size(), 5u);
  for (std::size_t k = 0; k < marks.size(); ++k)
    EXPECT_NEAR(marks[k].xi, (static_cast<double>(k) + 0.5) * block.settings.spacing_mm, 1e-9);
}

TEST_F(TipOnItsWay, goes_out_at_the_far_side_and_comes_back_into_its_track) {
  meet_skin();
  path.break_surface(1.0, report);
  for (int k = 0; k < 30 && path.phase() != TipState::exited; ++k) {
    if (path.tip.ahead.is_surface()) path.break_surface(1.0, report);
    cut(2.0);
  }
  ASSERT_EQ(path.phase(), TipState::exited);
  EXPECT_TRUE(path.tracks.now.open);
  EXPECT_FALSE(path.tip.touches());
  path.events.forget();
  block.put_tip(Vec3(1, 2, 39.0));
  path.pass_open_end({path.tip.force, {}}, report);
  EXPECT_EQ(path.phase(), TipState::in_track);
  EXPECT_EQ(kinds(path), std::vector{EventKind::re_entered});
}

TEST_F(TipOnItsWay, has_left_only_on_the_way_out) {
  meet_skin();
  path.break_surface(1.0, report);
  cut(2.0);
  path.tip.set_state(TipContact::State::open);
  block.put_tip(Vec3(1, 2, 1.0));
  EXPECT_FALSE(path.has_left(true)) << "still inside";
  block.put_tip(Vec3(1, 2, -0.5));
  EXPECT_TRUE(path.has_left(true));
  path.finish();
  path.come_out();
  EXPECT_TRUE(path.in_air());
  EXPECT_EQ(path.tracks.earlier().size(), 1u);
}

TEST_F(TipOnItsWay, the_shaft_takes_over_its_lateral_hold) {
  meet_skin();
  TipContact& tip = path.tip;
  EXPECT_TRUE(tip.has_lateral_rows());
  EXPECT_EQ(tip.lateral_softness(), 0.0);
  tip.hand_over(0.5);
  EXPECT_NEAR(tip.lateral_softness(), SimpleTissue::kOwn, 1e-12) << "as soft as the tissue itself";
  tip.hand_over(1.0);
  EXPECT_FALSE(tip.has_lateral_rows());
}

}  // namespace
}  // namespace stylet
