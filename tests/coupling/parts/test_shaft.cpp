// SPDX-License-Identifier: GPL-3.0-or-later
// The shaft contacts and the tissue's memory of them, without the other parts of an insertion.
#include "coupling/contacts/shaft_contacts.hpp"
#include "coupling/parts/simple_tissue.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

using test::SimpleTissue;

/// A needle in a straight track from the skin to its tip, with a mark every 4 mm from 2 mm on.
struct ShaftInTrack {
  explicit ShaftInTrack(double depth, const Creep& creep = {})
      : block(creep),
        marks(block.insertion, block.settings, *block.tissue),
        shaft(block.insertion, block.settings, block.needle, *block.tissue) {
    track.marks.reserve(10);
    marks.go_on_from(track, 2.0);
    track.end = Vec3(1, 2, depth);
    track.end_at = block.at(track.end);
    track.end_xi = depth;
    marks.lay(track, Vec3(1, 2, 0), 0.0, block.at(Vec3(1, 2, 0.1)).tet, report);
    block.put_tip(track.end);
  }
  double wake() {
    shaft.wake_and_drop(track, marks, Vec3::Zero(), report);
    return shaft.share_length(track);
  }

  SimpleTissue block;
  Marks marks;
  ShaftContacts shaft;
  Track track;
  Step report;
};

TEST(Marks, are_laid_at_their_spacing) {
  const ShaftInTrack needle(15.0);
  ASSERT_EQ(needle.track.marks.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(needle.track.marks[k].xi, 2.0 + 4.0 * static_cast<double>(k), 1e-12);
    EXPECT_NEAR(needle.track.marks[k].x.z(), needle.track.marks[k].xi, 1e-12);
  }
}

TEST(Marks, wait_for_compliance_that_is_not_there) {
  ShaftInTrack needle(15.0);
  needle.track.marks.clear();
  needle.marks.go_on_from({}, 2.0);
  needle.block.compliance->has_all = false;
  needle.marks.lay(needle.track, Vec3(1, 2, 0), 0.0, 0, needle.report);
  ASSERT_EQ(needle.track.marks.size(), 4u);
  EXPECT_EQ(needle.track.marks[0].point, -1);
  EXPECT_NE(needle.report.flags & Step::compliance_missing, 0u);
  EXPECT_EQ(needle.marks.represent(needle.track, 0, Vec3::UnitZ(), needle.report), Marks::Outcome::refused);
  needle.block.compliance->has_all = true;
  EXPECT_EQ(needle.marks.represent(needle.track, 0, Vec3::UnitZ(), needle.report), Marks::Outcome::there);
  EXPECT_GE(needle.track.marks[0].point, 0);
}

TEST(ShaftContacts, come_alive_where_the_tip_has_passed_and_go_where_it_has_gone_back) {
  ShaftInTrack needle(15.0);
  needle.wake();
  EXPECT_EQ(needle.shaft.count(), 4u);
  needle.block.put_tip(Vec3(1, 2, 7.0));
  for (ShaftContact& contact : needle.shaft.all()) contact.s += 8.0;  // the tissue stays, and the needle slides back
  needle.wake();
  EXPECT_EQ(needle.shaft.count(), 2u);
}

TEST(ShaftContacts, stand_for_the_whole_shaft_in_the_tissue) {
  for (const double depth : {2.5, 6.3, 9.0, 15.0, 19.9}) {
    ShaftInTrack needle(depth);
    needle.wake();
    double length = 0.0;
    for (const ShaftContact& contact : needle.shaft.all()) length += contact.length;
    // The piece of track before the first contact grows with the contact's age.
    const double young = needle.shaft.count() == 1 ? 2.0 : 1e-9;
    EXPECT_NEAR(length, depth, young) << depth;
    EXPECT_GT(length, depth - 2.0) << depth;
  }
}

TEST(ShaftContacts, are_born_soft_and_grow_hard_over_three_diameters) {
  ShaftInTrack needle(15.0);
  const double three_diameters = 6.0 * needle.block.settings.needle_radius_mm;
  needle.wake();
  for (const ShaftContact& contact : needle.shaft.all()) {
    const double rho = std::min(1.0, (15.0 - contact.xi) / three_diameters);
    EXPECT_NEAR(contact.softness, SimpleTissue::kOwn * (1.0 / rho - 1.0), 1e-9);
  }
  EXPECT_EQ(needle.shaft.all().front().softness, 0.0);
}

TEST(ShaftContacts, take_over_the_tips_lateral_hold_as_the_first_one_ages) {
  double before = 0.0;
  for (double depth = 2.1; depth < 6.5; depth += 0.2) {
    ShaftInTrack needle(depth);
    const double share = needle.wake();
    EXPECT_GE(share, before);
    EXPECT_LE(share - before, 0.2 / 3.0) << "without a jump";
    before = share;
  }
  EXPECT_EQ(before, 1.0);
}

TEST(TissueResponse, is_elastic_without_creep) {
  ShaftInTrack needle(15.0);
  needle.wake();
  for (ShaftContact& contact : needle.shaft.all()) contact.force = Vec3(0, 0, contact.xi);
  const Vec3 tip(0, 0, 3);
  const ContactForces forces{tip, needle.shaft.all()};
  const TissueResponse& tissue = *needle.block.tissue;
  EXPECT_EQ(tissue.displacement(ContactCompliance::kTip, forces), SimpleTissue::kOwn * tip);
  double energy = 0.5 * SimpleTissue::kOwn * 9.0;
  for (const ShaftContact& contact : needle.shaft.all()) {
    EXPECT_EQ(tissue.displacement(contact.point, forces), SimpleTissue::kOwn * contact.force);
    EXPECT_EQ(tissue.present_force(contact.point, forces), contact.force);
    energy += 0.5 * SimpleTissue::kOwn * contact.force.squaredNorm();
  }
  EXPECT_NEAR(tissue.energy(forces), energy, 1e-12);
}

TEST(TissueResponse, yields_at_once_then_creeps_and_goes_back_at_once_by_what_is_elastic) {
  ShaftInTrack needle(15.0, {3.0, 0.5});
  TissueResponse& tissue = *needle.block.tissue;
  const Vec3 force(0, 0, 1);
  const Vec3 none = Vec3::Zero();
  tissue.begin_tip(15.0);
  double before = SimpleTissue::kOwn;
  for (int k = 0; k < 5000; ++k) {
    tissue.begin(1e-3);
    const double now = tissue.displacement(ContactCompliance::kTip, {force, {}}).z();
    EXPECT_GE(now, before);
    before = now;
    tissue.end({force, {}}, needle.track);
  }
  EXPECT_NEAR(before, 3.0 * SimpleTissue::kOwn, 1e-3);
  EXPECT_NEAR(tissue.displacement(ContactCompliance::kTip, {none, {}}).z(), 2.0 * SimpleTissue::kOwn, 1e-3);
  tissue.let_go();
  EXPECT_TRUE(tissue.is_relaxing());
  for (int k = 0; k < 20000 && tissue.is_relaxing(); ++k) {
    tissue.begin(1e-3);
    tissue.relax({none, {}});
  }
  EXPECT_FALSE(tissue.is_relaxing()) << "once it is still it is as it was at first";
  EXPECT_EQ(tissue.displacement(ContactCompliance::kTip, {none, {}}), none);
}

TEST(TissueResponse, hands_what_the_tip_leaves_behind_to_the_track_without_losing_any) {
  ShaftInTrack needle(15.0, {3.0, 0.5});
  TissueResponse& tissue = *needle.block.tissue;
  const Vec3 force(0, 0, 1);
  const Vec3 none = Vec3::Zero();
  tissue.begin_tip(15.0);
  tissue.begin(0.1);
  tissue.end({force, {}}, needle.track);
  const int last = needle.track.marks.back().point;
  const double kept = tissue.lasting_force(ContactCompliance::kTip, {none, {}}).z();
  EXPECT_EQ(tissue.lasting_force(last, {none, {}}), none) << "it has not cut";
  tissue.leave_behind(needle.track, 0.25);
  EXPECT_NEAR(tissue.lasting_force(ContactCompliance::kTip, {none, {}}).z(), 0.75 * kept, 1e-12);
  EXPECT_NEAR(tissue.lasting_force(last, {none, {}}).z(), 0.25 * kept, 1e-12);
}

}  // namespace
}  // namespace stylet
