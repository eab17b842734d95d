// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of the balance: states of contacts, prediction, damping, and the kept compliance of the tissue.
#include "coupling/balance/contact_states.hpp"
#include "coupling/balance/cut_search.hpp"
#include "coupling/balance/effort.hpp"
#include "coupling/balance/iterate.hpp"
#include "coupling/balance/needle_damping.hpp"
#include "coupling/balance/needle_side.hpp"
#include "coupling/balance/predictor.hpp"
#include "coupling/balance/tissue_block.hpp"
#include "coupling/hand_force.hpp"
#include "coupling/paper/condensed_tissue.hpp"
#include "coupling/paper/damped_needle.hpp"
#include "coupling/parts/simple_tissue.hpp"
#include "stylet/needle/beam.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace stylet {
namespace {

using test::SimpleTissue;
using State = ShaftContact::State;

/// A tip that cuts at 12 mm, and three shaft contacts behind it.
struct NeedleInTissue {
  NeedleInTissue()
      : marks(block.insertion, block.settings, *block.tissue),
        shaft(block.insertion, block.settings, block.needle, *block.tissue),
        tip(block.settings, *block.locator, block.needle.base(), block.needle, *block.tissue),
        contacts{block.needle, *block.tissue, tip, shaft} {
    marks.go_on_from(track, 2.0);
    track.end = Vec3(1, 2, 12);
    track.end_at = block.at(track.end);
    track.end_xi = 12.0;
    Step report;
    marks.lay(track, Vec3(1, 2, 0), 0.0, block.at(Vec3(1, 2, 0.1)).tet, report);
    block.put_tip(track.end);
    shaft.wake_and_drop(track, marks, Vec3::Zero(), report);
    shaft.share_length(track);
    tip.put(track.end, track.end_at, true, TipContact::State::cut);
    tip.ahead.be_tissue(0, 0.3);
    tip.begin(contacts.forces());
  }
  ShaftContact& contact(int load) { return contacts.of_shaft(load); }

  SimpleTissue block;
  Track track;
  Marks marks;
  ShaftContacts shaft;
  TipContact tip;
  Contacts contacts;
};

TEST(Contacts, are_numbered_from_the_tip) {
  NeedleInTissue needle;
  ASSERT_EQ(needle.contacts.count(), 4);
  EXPECT_EQ(needle.contacts.point(0), ContactCompliance::kTip);
  EXPECT_EQ(needle.contacts.arc(0), needle.block.needle.length());
  EXPECT_NEAR(needle.contacts.arc(1), needle.block.needle.length() - 10.0, 1e-9);
  needle.contact(1).s = -3.0;
  EXPECT_EQ(needle.contacts.arc(1), 0.0);
}

TEST(ContactStates, a_sliding_contact_that_turns_round_is_held_where_it_was) {
  NeedleInTissue needle;
  ContactStates states(needle.contacts);
  states.begin(6);
  Step report;
  ShaftContact& contact = needle.contact(2);
  contact.state = State::forward;
  contact.reach = 1.0;
  contact.s_start = contact.s;
  contact.s += 0.01;
  EXPECT_EQ(states.contradiction(2, {.slides = 0.5}), 0.0);
  EXPECT_GT(states.contradiction(2, {.slides = -0.01}), 0.0);
  states.change(2, {.slides = -0.01}, report);
  EXPECT_EQ(contact.state, State::stick);
  EXPECT_EQ(contact.s, contact.s_start);
}

TEST(ContactStates, a_contact_that_changes_too_often_keeps_its_state_and_the_step_is_flagged) {
  NeedleInTissue needle;
  ContactStates states(needle.contacts);
  states.begin(2);
  Step report;
  needle.contact(1).state = State::stick;
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(report.flags & Step::contact_cycling, 0u);
    states.change(1, {.axial = k % 2 == 0 ? 1.0 : 0.0, .slides = -1.0}, report);
  }
  EXPECT_NE(report.flags & Step::contact_cycling, 0u);
  EXPECT_EQ(states.contradiction(1, {.axial = 100.0, .slides = -1.0}), 0.0);
}

/// One sub-step in which the base moves by `way` along z and all forces change by `gain`.
void pass(Predictor& predictor, NeedleInTissue& needle, double way, double gain) {
  const Pose before = needle.block.needle.base();
  Pose now = before;
  now.origin.z() += way;
  needle.block.needle.set_base(now);
  predictor.begin(before, now, needle.block.needle, needle.tip, needle.shaft.all());
  needle.tip.force += Vec3(0, 0, gain);
  for (ShaftContact& contact : needle.shaft.all()) {
    contact.force += Vec3(0, 0, gain);
    contact.toggles = 0;
  }
  predictor.end(0.0, true, needle.block.needle, needle.tip, needle.shaft.all());
}

/// Predicted change of the tip's force in the next sub-step.
double expected_gain(Predictor& predictor, NeedleInTissue& needle, double way) {
  const Pose before = needle.block.needle.base();
  Pose now = before;
  now.origin.z() += way;
  predictor.begin(before, now, needle.block.needle, needle.tip, needle.shaft.all());
  const double force = needle.tip.force.z();
  predictor.go_on(needle.block.needle, needle.tip, needle.shaft.all());
  return needle.tip.force.z() - force;
}

TEST(Predictor, goes_on_in_proportion_to_the_bases_motion) {
  NeedleInTissue needle;
  Predictor predictor(needle.block.needle.state().size());
  pass(predictor, needle, 0.1, 0.02);
  pass(predictor, needle, 0.1, 0.02);
  pass(predictor, needle, 0.1, 0.02);
  EXPECT_NEAR(expected_gain(predictor, needle, 0.05), 0.01, 1e-12);
  for (const ShaftContact& contact : needle.shaft.all()) EXPECT_NEAR(contact.force.z(), 0.07, 1e-12);
}

TEST(Predictor, changes_its_pace_as_it_did_before) {
  NeedleInTissue needle;
  Predictor predictor(needle.block.needle.state().size());
  for (int k = 1; k <= 4; ++k) pass(predictor, needle, 0.1, 0.01 * k);
  EXPECT_NEAR(expected_gain(predictor, needle, 0.1), 0.05, 1e-12) << "0.01, 0.02, 0.03, 0.04, …";
}

TEST(Predictor, expects_nothing_after_a_turn_and_after_a_step_without_a_balance) {
  NeedleInTissue needle;
  Predictor predictor(needle.block.needle.state().size());
  for (int k = 0; k < 3; ++k) pass(predictor, needle, 0.1, 0.02);
  EXPECT_EQ(expected_gain(predictor, needle, -0.1), 0.0);
  for (int k = 0; k < 3; ++k) pass(predictor, needle, 0.1, 0.02);
  predictor.interrupt();
  EXPECT_EQ(expected_gain(predictor, needle, 0.1), 0.0);
}

TEST(Predictor, goes_back_to_where_the_sub_step_began) {
  NeedleInTissue needle;
  Predictor predictor(needle.block.needle.state().size());
  for (int k = 0; k < 3; ++k) pass(predictor, needle, 0.1, 0.02);
  for (ShaftContact& contact : needle.shaft.all()) contact.slid = -0.1;
  const Vec3 force = needle.tip.force;
  const double s = needle.contact(1).s;
  EXPECT_NE(expected_gain(predictor, needle, 0.1), 0.0);
  EXPECT_NE(needle.contact(1).s, s);
  predictor.go_back(needle.block.needle, needle.tip, needle.shaft.all());
  EXPECT_EQ(needle.tip.force, force);
  EXPECT_EQ(needle.contact(1).s, s);
}

TEST(NeedleDamping, grows_with_the_time_on_bone_up_to_its_most) {
  NeedleDamping damping(3e-3);
  EXPECT_EQ(damping.in_step(1e-3, false, false), 0.0);
  EXPECT_NEAR(damping.in_step(1e-3, true, false), 1e-4, 1e-12);
  for (int k = 0; k < 100; ++k) damping.end(1e-3, true, true);
  EXPECT_EQ(damping.in_step(1e-3, true, false), 3e-3);
  damping.end(1e-3, false, true);
  EXPECT_NEAR(damping.in_step(1e-3, true, false), 1e-4, 1e-12) << "it had left the bone";
}

TEST(NeedleDamping, is_that_of_a_needle_that_snaps_in_parts_of_a_sub_step_only) {
  NeedleDamping damping(3e-3);
  EXPECT_EQ(damping.in_step(1e-3, false, true), 3e-3);
  damping.end(1e-3, false, false);
  EXPECT_EQ(damping.in_step(1e-3, false, false), 0.0) << "a step without a balance leaves no damping";
}

/// Searches for the length of cut where p(a) = a. @return number of proposals until |p(a) − a| < 1e-9; 60: not found
template <class Proposal>
int searches(Proposal&& p, double from = 0.0) {
  CutSearch search;
  double at = from;
  for (int k = 0; k < 60; ++k) {
    const double proposed = p(at);
    if (std::abs(proposed - at) < 1e-9) return k;
    at = search.next(at, proposed);
  }
  return 60;
}

TEST(CutSearch, finds_the_length_though_proposals_run_back_and_forth_or_away) {
  for (const double slope : {0.9, 0.5, 0.0, -0.55, -1.0, -3.0, -20.0})
    EXPECT_LE(searches([slope](double a) { return 1.3 + slope * (a - 1.3); }), slope > 0.7 ? 40 : 3) << slope;
  EXPECT_LE(searches([](double a) { return 2.0 / (1.0 + a * a * a); }), 10);
  EXPECT_LE(searches([](double a) { return 1.0 / (0.02 + a); }), 14);
}

TEST(CutSearch, closes_in_on_a_jump_between_too_short_and_too_long) {
  CutSearch search;
  double at = 0.1;
  double shortest = 0.0, longest = 10.0;
  for (int k = 0; k < 40; ++k) {
    (at < 0.7 ? shortest : longest) = at;
    at = search.next(at, at < 0.7 ? at + 0.5 : at - 0.4);
    EXPECT_GT(at, shortest);
    EXPECT_LT(at, longest);
  }
  EXPECT_LT(longest - shortest, 1e-4);
}

TEST(Effort, of_one_needle_allows_three_tangents_and_six_iterations_with_any_number_of_contacts) {
  for (const int contacts : {1, 40, 200}) {
    Effort effort(contacts);
    for (int k = 0; k < 3; ++k) effort.spend(effort.tangent());
    for (int k = 0; k < 5; ++k) effort.spend(effort.iteration());
    EXPECT_TRUE(effort.allows(effort.iteration())) << contacts;
  }
  Effort effort(200);
  EXPECT_FALSE(effort.allows(4.0 * effort.tangent() + 6.0 * effort.iteration()));
}

TEST(Effort, is_not_bounded_while_needles_rest_in_the_tissue) {
  const Effort effort(200, true);
  EXPECT_TRUE(effort.allows(1000.0 * effort.tangent()));
}

TEST(HandForce, at_a_puncture_is_found_between_the_balances) {
  NeedleInTissue needle;
  HandForce hand(needle.block.needle.base(), needle.block.needle);
  needle.tip.force = Vec3(0, 0, 0.6);
  hand.begin(needle.contacts.forces(), true);
  const Vec3 start = needle.tip.force;
  needle.tip.force = Vec3(0, 0, 1.4);
  for (ShaftContact& contact : needle.shaft.all()) contact.force = Vec3(0, 0, 0.2);
  EXPECT_NEAR(hand.when_tip_reached(1.0, start, needle.contacts.forces()), 0.5 * 0.6 + 0.5 * 2.0, 1e-12);
  hand.begin(needle.contacts.forces(), false);
  EXPECT_NEAR(hand.when_tip_reached(1.0, start, needle.contacts.forces()), 2.0, 1e-12) << "none was there before";
}

TEST(Iterate, is_come_back_to) {
  NeedleInTissue needle;
  Iterate kept(needle.block.needle.state().size(), needle.block.settings.capacity);
  needle.tip.force = Vec3(1, 2, 3);
  needle.tip.cut.march(0.2);
  needle.contact(2).force = Vec3(0, 0, 1);
  const double s = needle.contact(2).s;
  kept.keep(needle.contacts);
  needle.tip.force.setZero();
  needle.tip.cut.march(0.7);
  needle.contact(2).force.setZero();
  needle.contact(2).s = 0.0;
  kept.restore(needle.contacts);
  EXPECT_EQ(needle.tip.force, Vec3(1, 2, 3));
  EXPECT_NEAR(needle.tip.cut.advance(), 0.2, 1e-12);
  EXPECT_EQ(needle.contact(2).force, Vec3(0, 0, 1));
  EXPECT_EQ(needle.contact(2).s, s);
}

/// A random symmetric compliance with a given number of points.
void fill(MatX& A, int points, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(points);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) A(i, j) = A(j, i) = number(random);
}

TEST(NeedleSide, a_contact_that_is_added_has_its_rows_in_both_triangles) {
  NeedleSide side(5);
  side.count = 2;
  fill(side.N, 2, 1);
  auto rows = side.next_rows();
  ASSERT_EQ(rows.rows(), 3);
  ASSERT_EQ(rows.cols(), 9);
  for (Eigen::Index j = 0; j < 9; ++j)
    for (Eigen::Index i = 0; i < 3; ++i) rows(i, j) = static_cast<double>(10 * i + j);
  rows.rightCols<3>() = Mat3::Identity();
  side.add_contact();
  EXPECT_EQ(side.count, 3);
  EXPECT_EQ(side.compliance(), side.compliance().transpose());
}

TEST(NeedleSide, lends_its_springs_only_where_it_is_supported) {
  NeedleSide side(4);
  side.count = 4;
  side.spring[0].stiffness = side.spring[2].stiffness = 1.0;
  EXPECT_TRUE(side.shaft_springs().empty());
  EXPECT_FALSE(side.lends_at_tip());
  side.supported = true;
  ASSERT_EQ(side.shaft_springs().size(), 3u);
  EXPECT_EQ(side.shaft_springs()[1].stiffness, 1.0);
  EXPECT_TRUE(side.lends_at_tip());
}

TEST(TissueBlock, is_the_compliances_block_of_the_present_contacts) {
  NeedleInTissue needle;
  ContactRows rows(needle.block.settings, 10);
  ContactSystem system(rows, 10, 0);
  TissueBlock block(system, 10);
  const auto expect_whole = [&] {
    const ContactCompliance& compliance = needle.block.tissue->compliance();
    for (int c = 0; c < needle.contacts.count(); ++c) {
      for (int d = 0; d < needle.contacts.count(); ++d) {
        const Mat3 block_of_A = system.A.block<3, 3>(3 * c, 3 * d);
        EXPECT_EQ(block_of_A, compliance(needle.contacts.point(c), needle.contacts.point(d)));
      }
    }
  };
  EXPECT_EQ(block.renew(needle.contacts), 0);
  block.gather(needle.contacts, 0);
  expect_whole();
  EXPECT_EQ(block.renew(needle.contacts), 4) << "nothing is new";
  needle.shaft.all()[2].s = needle.block.needle.length();
  Step report;
  needle.track.marks.resize(2);
  needle.shaft.wake_and_drop(needle.track, needle.marks, Vec3::Zero(), report);
  EXPECT_EQ(block.renew(needle.contacts), 3);
  EXPECT_EQ(block.before(), 4);
  block.gather(needle.contacts, 3);
  expect_whole();
}

TEST(TissueBlock, foresees_how_gaps_change_with_a_cut_that_leads_aside) {
  NeedleInTissue needle;
  ContactRows rows(needle.block.settings, 10);
  ContactSystem system(rows, 10, 0);
  TissueBlock block(system, 10);
  rows.take_places(needle.contacts);
  block.gather(needle.contacts, block.renew(needle.contacts));
  const Vec3 aside = Vec3(0.2, 0.0, 1.0).normalized();
  needle.tip.cut.aim(aside);
  block.gather_drift(needle.contacts, {}, rows);
  EXPECT_NEAR((rows.tip.drift.head<3>() - (aside - Vec3::UnitZ())).norm(), 0.0, 1e-12)
      << "this tissue is the same everywhere";
}

TEST(DampedNeedle, bends_into_the_shape_that_its_loads_alone_would_give_it) {
  const std::vector<PointLoad> loads{{150.0, Vec3(0.2, 0, 0)}, {80.0, Vec3(0, -0.3, 0)}};
  const auto free = BeamNeedle::build({150.0, 1.27, 15700, 12100}, 20, 4).value();
  ASSERT_TRUE(find_equilibrium(*free, loads, 1e-10));
  const auto needle = BeamNeedle::build({150.0, 1.27, 15700, 12100}, 20, 4).value();
  paper::DampedNeedle bent(needle->state().size(), 4);
  bent.spring(0) = 0.05 * Mat3::Identity();
  bent.spring(1) = 0.5 * Mat3::Identity();
  const Vec3 straight = needle->point(150.0);
  bent.bend(*needle, loads);
  EXPECT_LT((needle->point(150.0) - straight).norm(), 0.9 * (free->point(150.0) - straight).norm()) << "step by step";
  for (int k = 0; k < 200; ++k) bent.bend(*needle, loads);
  EXPECT_NEAR((needle->point(150.0) - free->point(150.0)).norm(), 0.0, 1e-7);
}

TEST(CondensedTissue, is_the_tissues_compliance_while_all_rows_are_forces) {
  NeedleInTissue needle;
  paper::CondensedTissue tissue(10);
  std::vector<Mat3> frames(10, Mat3::Identity());
  tissue.take(needle.contacts, frames);
  ASSERT_EQ(tissue.system().points(), 4);
  for (int c = 0; c < 4; ++c) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(tissue.own(tissue.row(c) + k), SimpleTissue::kOwn);
  }
}

TEST(CondensedTissue, keeps_every_contacts_rows_apart_when_the_tip_moves_on_and_frames_turn) {
  NeedleInTissue needle;
  paper::CondensedTissue tissue(10);
  std::vector<Mat3> frames(10, Mat3::Identity());
  tissue.take(needle.contacts, frames);
  needle.tip.cut.march(0.5);
  const Mat3 turned = Eigen::AngleAxisd(0.3, Vec3::UnitX()).toRotationMatrix();
  tissue.turn(2, turned);
  frames[2] = turned;
  tissue.take(needle.contacts, frames);
  std::set<int> rows;
  for (int c = 0; c < 4; ++c) {
    rows.insert(tissue.row(c));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(tissue.own(tissue.row(c) + k), SimpleTissue::kOwn, 1e-12);
  }
  EXPECT_EQ(rows.size(), 4u);
}

}  // namespace
}  // namespace stylet
