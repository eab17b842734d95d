// SPDX-License-Identifier: GPL-3.0-or-later
// Laws between needle and tissue, read from the force of the hand with the default coupling: friction over speed, per
// region and at rest; membranes; withdrawal along a track; the bevel.
#include "mirrored_block.hpp"
#include "needle_in_block.hpp"

#include <algorithm>
#include <numbers>

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;
using Kind = EventKind;

constexpr FrictionLaw kFriction{18e-3, 11e-3, 250e-6, 50.0};

double sliding_N_per_mm(const FrictionLaw& law, double speed) {
  return law.coulomb_N_per_mm + law.viscous_Ns_per_mm2 * std::min(speed, law.viscous_to_mm_per_s);
}

// A slab whose two faces are free, and a needle that passes all the way through it. Nothing is cut, and equal lengths
// of shaft enter and leave, so at a steady speed the tissue is at rest, every contact slides at the speed of the hand,
// and the hand bears friction alone.

BlockOptions slab(double thickness, int layers, double spacing) {
  BlockOptions options;
  options.element = Element::nodal_pressure;
  options.hi.z() = thickness;
  options.cells = {4, 4, layers};
  options.regions = {"body"};
  options.region_at = [](const Vec3&) { return 0; };
  options.materials = {{0.06, 0.45}};
  options.laws = {{0.35, 1.0, kFriction, false, true, -1}};
  options.held = [](const Vec3& x) { return std::abs(x.x()) > 49.9 || std::abs(x.y()) > 49.9; };
  options.coupling.spacing_mm = spacing;
  return options;
}

/// The same with another region below `interface_mm`.
BlockOptions layered_slab(double thickness, int layers, double spacing, double interface_mm, const FrictionLaw& deep) {
  BlockOptions options = slab(thickness, layers, spacing);
  options.regions = {"body", "deep"};
  options.region_at = [interface_mm](const Vec3& x) { return x.z() > interface_mm ? 1 : 0; };
  options.materials = {{0.06, 0.45}, {0.04, 0.45}};
  options.laws.push_back({0.35, 0.0, deep, false, false, -1});
  return options;
}

void pierce(NeedleInBlock& run, double depth) {
  run.aim({3, 2, 0});
  run.go(depth, 20.0, 0.25 / 20.0);
  ASSERT_EQ(run.report.tip_state, TipState::exited);
}

/// Moves the base by `way` (negative: back), with one sub-step per step.
void move(NeedleInBlock& run, double way, double speed) { run.go(run.depth + way, speed, 0.25 / speed); }

TEST(Friction, is_coulomb_and_viscous_per_length_up_to_a_speed_and_constant_beyond) {
  NeedleInBlock run(slab(40.0, 4, 4.0));
  pierce(run, 50.0);
  for (const double speed : {0.5, 5.0, 20.0, 49.0, 60.0, 100.0, 200.0}) {
    for (const double sign : {1.0, -1.0}) {
      // The tissue comes to rest within about b ℓ A = 10 ms; it has a quarter of a second.
      move(run, sign * std::max(2.0, 0.25 * speed), speed);
      const double law = 40.0 * sliding_N_per_mm(kFriction, speed);
      // Above the speed where friction stops growing, a thousandth of the viscosity is kept, so that speeds stay
      // determined.
      const double beyond = 40.0 * 1e-3 * kFriction.viscous_Ns_per_mm2 * std::max(0.0, speed - 50.0);
      EXPECT_NEAR(sign * run.forces.back(), law + beyond, 2e-4 * law) << sign * speed << " mm/s";
      EXPECT_EQ(run.report.sliding_share, 1.0);
    }
  }
  EXPECT_EQ(run.flags, 0u);
}

TEST(Friction, is_that_of_each_region_over_the_length_in_it) {
  const FrictionLaw deep{36e-3, 30e-3, 100e-6, 50.0};
  const double interface_mm = 3.0 * 40.0 / 7.0;
  const double law =
      interface_mm * sliding_N_per_mm(kFriction, 10.0) + (40.0 - interface_mm) * sliding_N_per_mm(deep, 10.0);
  for (const double spacing : {2.0, 8.0}) {
    SCOPED_TRACE(testing::Message() << spacing << " mm between contacts");
    NeedleInBlock run(layered_slab(40.0, 7, spacing, interface_mm, deep));
    pierce(run, 55.0);
    move(run, 5.0, 10.0);
    std::array<double, 2> force{};
    std::array<double, 2> length{};
    const std::vector<ContactState> contacts = run.insertion->contacts();
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const auto region = static_cast<std::size_t>(run.insertion->track().marks[k].region);
      force[region] += contacts[k].force.z();
      length[region] += contacts[k].length;
    }
    EXPECT_NEAR(force[0], length[0] * sliding_N_per_mm(kFriction, 10.0), 2e-4 * force[0]);
    EXPECT_NEAR(force[1], length[1] * sliding_N_per_mm(deep, 10.0), 2e-4 * force[1]);
    // A contact is as long as the spacing and has the law of its middle, so half of it may lie beyond the interface.
    const double astride = 0.5 * spacing;
    EXPECT_NEAR(length[0], interface_mm, astride);
    EXPECT_NEAR(length[1], 40.0 - interface_mm, astride);
    const double difference = sliding_N_per_mm(deep, 10.0) - sliding_N_per_mm(kFriction, 10.0);
    EXPECT_NEAR(run.forces.back(), law, difference * astride + 2e-4 * law);
    EXPECT_EQ(run.flags, 0u);
  }
}

TEST(Friction, holds_a_needle_at_rest_up_to_the_static_limit_and_then_comes_down_to_coulombs) {
  const double length = 16.0;
  NeedleInBlock run(slab(length, 4, length));  // one contact, which has the whole length
  pierce(run, 45.0);
  const double step_mm = 2e-3;
  const double speed = 0.5;
  for (const double sign : {1.0, -1.0}) {
    run.wait(1.0, 0.05);
    ASSERT_EQ(run.report.contacts, 1);
    ASSERT_EQ(run.report.sticking, 1);
    const double rise = step_mm / run.insertion->compliance()(1, 1)(2, 2);
    const double limit = kFriction.static_N_per_mm * run.report.inserted_mm;
    double peak = 0.0;
    for (int k = 0; k < 1000; ++k) {  // from Coulomb friction in one direction to the static limit in the other, and
                                      // beyond
      run.depth += sign * step_mm;
      run.step(step_mm / speed);
      peak = std::max(peak, sign * run.forces.back());
    }
    EXPECT_LE(peak, limit + 1e-6);
    EXPECT_GE(peak, limit - 1.1 * rise);
    const double law = run.report.inserted_mm * sliding_N_per_mm(kFriction, speed);
    EXPECT_NEAR(sign * run.forces.back(), law, 1e-3 * law);
    EXPECT_EQ(run.report.sliding_share, 1.0);
  }
  EXPECT_EQ(run.flags, 0u);
}

TEST(Friction, has_the_static_limit_of_each_region) {
  const FrictionLaw deep{24e-3, 11e-3, 250e-6, 50.0};
  NeedleInBlock run(layered_slab(32.0, 4, 16.0, 16.0, deep));  // one contact in each region
  pierce(run, 60.0);
  run.wait(1.0, 0.05);
  ASSERT_EQ(run.report.contacts, 2);
  ASSERT_EQ(run.report.sticking, 2);
  const double step_mm = 2e-3;
  std::array<double, 2> most{};  // [N/mm] largest force per length while sticking
  std::array<double, 2> rise{};  // [N/mm] rise of this force in one step
  for (int k = 0; k < 600; ++k) {
    run.depth += step_mm;
    run.step(step_mm / 0.5);
    const std::vector<ContactState> contacts = run.insertion->contacts();
    for (std::size_t c = 0; c < 2; ++c) {
      const int point = static_cast<int>(c) + 1;
      rise[c] = step_mm / run.insertion->compliance()(point, point)(2, 2) / contacts[c].length;
      if (contacts[c].sticking) most[c] = std::max(most[c], contacts[c].force.z() / contacts[c].length);
    }
  }
  for (std::size_t c = 0; c < 2; ++c) {
    const double limit = (c == 0 ? kFriction : deep).static_N_per_mm;
    EXPECT_LE(most[c], limit + 1e-6);
    EXPECT_GE(most[c], limit - 1.1 * rise[c]);
  }
  EXPECT_EQ(run.report.sliding_share, 1.0);
}

TEST(Friction, of_many_contacts_lets_go_between_coulombs_and_the_static_limit) {
  // The tissue distributes a load unevenly: some contacts reach the static limit, and then fall to Coulomb friction,
  // before the others.
  NeedleInBlock run(slab(40.0, 4, 4.0));
  pierce(run, 60.0);
  run.wait(1.0, 0.05);
  ASSERT_EQ(run.report.sticking, 10);
  double peak = 0.0;
  for (int k = 0; k < 300; ++k) {
    run.depth += 5e-3;
    run.step(0.01);
    peak = std::max(peak, run.forces.back());
    for (const ContactState& contact : run.insertion->contacts()) {
      if (contact.sticking) {
        EXPECT_LE(contact.force.norm(), kFriction.static_N_per_mm * contact.length + 1e-6);
      }
    }
  }
  const double law = 40.0 * sliding_N_per_mm(kFriction, 0.5);
  EXPECT_NEAR(run.forces.back(), law, 1e-3 * law);
  EXPECT_GT(peak, 1.2 * law);
  EXPECT_LT(peak, 40.0 * kFriction.static_N_per_mm);
}

TEST(ZeroBand, a_needle_at_rest_is_held_and_its_force_stays) {
  NeedleInBlock run(slab(40.0, 4, 4.0));
  pierce(run, 60.0);
  run.wait(1.0, 0.05);
  EXPECT_EQ(run.report.sticking, run.report.contacts);
  const double force = run.forces.back();
  // After a push, the contacts still bear sliding friction, and less than the viscous part at the zero band's speed in
  // addition.
  const double coulomb = 40.0 * kFriction.coulomb_N_per_mm;
  EXPECT_NEAR(force, coulomb, 2e-4 * coulomb + 40.0 * kFriction.viscous_Ns_per_mm2 * 0.005);
  run.wait(100.0, 1.0);
  EXPECT_NEAR(run.forces.back(), force, 1e-9);
}

/// Slides at 0.5 mm/s first, and then moves by `way` at `speed`.
std::vector<double> creep(NeedleInBlock& run, double way, double speed, double dt) {
  pierce(run, 50.0);
  run.go(50.5, 0.5, 0.05);
  const auto before = static_cast<std::ptrdiff_t>(run.forces.size());
  run.go(50.5 + way, speed, dt);
  EXPECT_EQ(run.flags, 0u);
  return {run.forces.begin() + before, run.forces.end()};
}

TEST(ZeroBand, just_above_it_the_sliding_law_holds_at_any_time_step) {
  const CouplingSettings defaults;
  const double speed = 1.2 * defaults.zero_band_mm_per_s;
  const double law = 40.0 * sliding_N_per_mm(kFriction, speed);
  for (const double dt : {0.05, 0.2, 1.0}) {
    NeedleInBlock run(slab(40.0, 4, 4.0));
    EXPECT_NEAR(creep(run, 0.06, speed, dt).back(), law, 2e-4 * law) << "dt " << dt;
    EXPECT_EQ(run.report.sliding_share, 1.0) << "dt " << dt;
  }
}

TEST(ZeroBand, below_it_a_contact_sticks_and_slips_between_static_limit_and_coulomb_at_any_time_step) {
  const CouplingSettings defaults;
  const double speed = 0.8 * defaults.zero_band_mm_per_s;
  for (const double dt : {0.05, 0.2, 1.0}) {
    SCOPED_TRACE(testing::Message() << "dt " << dt);
    NeedleInBlock run(slab(16.0, 4, 16.0));  // one contact
    const std::vector<double> force = creep(run, 0.5, speed, dt);
    const double length = run.report.inserted_mm;
    const double rise = speed * dt / run.insertion->compliance()(1, 1)(2, 2);
    const auto top = std::max_element(force.begin(), force.end());
    EXPECT_LE(*top, kFriction.static_N_per_mm * length + 1e-6);
    EXPECT_GE(*top, kFriction.static_N_per_mm * length - 1.1 * rise);
    // It sticks again while it still slides forward, but more slowly than the zero band.
    const double bottom = *std::min_element(top, force.end());
    EXPECT_GE(bottom, kFriction.coulomb_N_per_mm * length - 1e-6);
    EXPECT_LE(bottom, sliding_N_per_mm(kFriction, defaults.zero_band_mm_per_s) * length + 1e-6);
    EXPECT_EQ(run.report.sticking, 1);
  }
}

TEST(ZeroBand, without_one_the_sliding_law_goes_on) {
  BlockOptions options = slab(16.0, 4, 16.0);
  options.coupling.zero_band_mm_per_s = 0.0;
  NeedleInBlock run(options);
  const double force = creep(run, 0.06, 0.004, 0.2).back();
  const double law = sliding_N_per_mm(kFriction, 0.004) * run.report.inserted_mm;
  EXPECT_NEAR(force, law, 2e-4 * law);
  EXPECT_EQ(run.report.sticking, 0);
}

/// Skin, and below `depth_mm` an organ.
BlockOptions organ_under_skin(double depth_mm = 20.0) {
  BlockOptions options;
  options.element = Element::nodal_pressure;
  options.cells = {5, 5, depth_mm < 20.0 ? 25 : 5};
  options.region_at = [depth_mm](const Vec3& x) { return x.z() > depth_mm ? 1 : 0; };
  return options;
}

/// The force of the hand before and after a membrane breaks.
struct Drop {
  double before_N = 0.0;                                      ///< at the moment when it breaks
  double lowest_N = std::numeric_limits<double>::infinity();  ///< within 5 mm
  double inserted_mm = 0.0;                                   ///< inserted length at the lowest force
};

/// The drops of skin and capsule.
std::vector<Drop> drops(double speed, double dt) {
  constexpr double within_mm = 5.0;
  NeedleInBlock run(organ_under_skin());
  run.aim({3, 2, 0});
  std::vector<Drop> found;
  double last_break = 0.0;
  while (run.depth < 34.0) {
    run.depth += speed * dt;
    run.step(dt);
    for (const InsertionEvent& event : run.insertion->events()) {
      if (event.kind != Kind::puncture) continue;
      found.push_back({event.force_N});
      last_break = run.depth;
    }
    if (found.empty() || run.depth > last_break + within_mm || run.forces.back() >= found.back().lowest_N) continue;
    found.back().lowest_N = run.forces.back();
    found.back().inserted_mm = run.report.inserted_mm;
  }
  EXPECT_EQ(run.flags, 0u);
  return found;
}

TEST(Membrane, force_of_the_hand_drops_to_cutting_and_friction_when_skin_and_capsule_break_the_same_at_any_time_step) {
  const BlockOptions options = organ_under_skin();
  const double speed = 20.0;
  const std::vector<Drop> fine = drops(speed, 0.25e-3);
  ASSERT_EQ(fine.size(), 2u);
  const double peak = std::max(fine[0].before_N, fine[1].before_N);
  EXPECT_NEAR(fine[0].before_N, options.laws[0].puncture_N, 1e-3);
  for (std::size_t m = 0; m < 2; ++m) {
    // The tip jumps forward and tissue springs back along the shaft, so contacts slide at least as fast as the hand.
    const double cutting = options.laws[m].cutting_N;
    const double tip = options.coupling.tip_viscosity_Ns_per_mm * speed;
    EXPECT_GT(fine[m].lowest_N, cutting + kFriction.coulomb_N_per_mm * fine[m].inserted_mm);
    EXPECT_LT(fine[m].lowest_N, cutting + tip + sliding_N_per_mm(kFriction, 50.0) * fine[m].inserted_mm);
    EXPECT_LT(fine[m].lowest_N, 0.9 * fine[m].before_N);
  }
  for (const double dt : {1e-3, 2e-3}) {
    const std::vector<Drop> coarse = drops(speed, dt);
    ASSERT_EQ(coarse.size(), 2u);
    for (std::size_t m = 0; m < 2; ++m) {
      EXPECT_NEAR(coarse[m].before_N, fine[m].before_N, 0.01 * peak) << "dt " << dt;
      EXPECT_NEAR(coarse[m].lowest_N, fine[m].lowest_N, 0.01 * peak) << "dt " << dt;
    }
  }
}

class OrganWithoutMembrane : public testing::TestWithParam<double> {};

TEST_P(OrganWithoutMembrane, of_the_same_tissue_might_as_well_not_be_there) {
  // In the dent of the skin, and below it.
  const double depth_mm = GetParam();
  BlockOptions options = organ_under_skin(depth_mm);
  options.materials[1] = options.materials[0];
  options.laws[1] = options.laws[0];
  options.laws[1].surrounding = false;
  options.laws[1].puncture_N = 0.0;
  BlockOptions plain = options;
  plain.region_at = [](const Vec3&) { return 0; };
  const double speed = 20.0;
  const double dt = 2e-3;
  NeedleInBlock with(options);
  NeedleInBlock without(plain);
  for (NeedleInBlock* run : {&with, &without}) {
    run->aim({3, 2, 0});
    run->go(32, speed, dt);
    EXPECT_EQ(run->flags, 0u);
  }
  EXPECT_EQ(with.count(Kind::region_entered, 1), 1);
  EXPECT_EQ(with.count(Kind::puncture), 1) << "the skin's only";
  // The cut ends at the surface for one sub-step, so the tip is late by one step at most.
  const double late_N = speed * dt / with.insertion->compliance()(0, 0)(2, 2);
  double worst = 0.0;
  double fall = 0.0;
  for (std::size_t k = 1; k < with.forces.size(); ++k) {
    const double in_a_step = std::abs(without.forces[k] - without.forces[k - 1]);
    worst = std::max(worst, std::abs(with.forces[k] - without.forces[k]) - in_a_step);
    if (with.depths[k] > std::max(depth_mm, 20.0)) fall = std::max(fall, with.forces[k - 1] - with.forces[k]);
  }
  EXPECT_LT(worst, late_N);
  EXPECT_LT(fall, late_N);
}

INSTANTIATE_TEST_SUITE_P(Depths, OrganWithoutMembrane, testing::Values(4.0, 8.0, 20.0),
                         [](const auto& tested) { return std::to_string(static_cast<int>(tested.param)) + "_mm"; });

TEST(Membrane, a_second_pass_along_the_track_needs_friction_only) {
  NeedleInBlock run(organ_under_skin());
  run.aim({3, 2, 0});
  run.go(40, 20.0, 5e-3);
  run.go(-1, 20.0, 5e-3);
  ASSERT_EQ(run.count(Kind::withdrawn), 1);
  run.happened.clear();
  run.aim({3, 2, 0});
  for (const double depth : {8.0, 16.0, 24.0, 32.0}) {  // through skin and capsule
    run.go(depth, 20.0, 5e-3);
    EXPECT_EQ(run.report.tip_state, TipState::in_track);
    EXPECT_FALSE(run.insertion->contacts().front().tip);
    // Friction grows with the length and drags the tissue along, so the shaft slides more slowly than the hand moves.
    EXPECT_GT(run.forces.back(), kFriction.coulomb_N_per_mm * run.report.inserted_mm) << depth;
    EXPECT_LT(run.forces.back(), sliding_N_per_mm(kFriction, 20.0) * run.report.inserted_mm) << depth;
  }
  EXPECT_EQ(run.count(Kind::puncture), 0);
  EXPECT_EQ(run.count(Kind::region_entered), 0);
  EXPECT_EQ(run.flags, 0u);
}

/// Sideways motion of a tip of 0 or 20° in a block that is its own mirror image.
double sideways(bool bevelled, Bevel::Law law, double roll, double spacing_mm = 4.0) {
  BlockOptions options;
  options.element = Element::nodal_pressure;
  options.lo.x() = 0.0;
  options.cells = {2, 4, 5};
  options.edit = test::mirror;
  options.regions = {"body"};
  options.region_at = [](const Vec3&) { return 0; };
  options.materials = {{0.03, 0.45}};
  options.laws = {{0.35, 0.5, kFriction, false, true, -1}};
  options.coupling.bevel.angle_rad = bevelled ? std::numbers::pi / 9.0 : 0.0;
  options.coupling.bevel.law = law;
  options.coupling.spacing_mm = spacing_mm;
  NeedleInBlock run(options);
  run.roll = roll;
  run.aim({0.0, 2.0, 0.0});
  run.go(40.0, 20.0, 5e-3);
  EXPECT_EQ(run.flags, 0u);
  return run.report.tip_mm.x();
}

class TipInTheNearField : public testing::TestWithParam<Bevel::Law> {};

TEST_P(TipInTheNearField, is_drawn_to_the_side_roll_says_and_nowhere_without_a_bevel) {
  const double bevel = sideways(true, GetParam(), 0.0);
  EXPECT_GT(bevel, 0.1);
  // The two differ only by the side of the plane to which the elements around the entry are assigned.
  EXPECT_NEAR(sideways(true, GetParam(), std::numbers::pi), -bevel, 0.01 * bevel);
  EXPECT_NEAR(sideways(true, GetParam(), 0.5 * std::numbers::pi), 0.0, 1e-9 * bevel);
  EXPECT_NEAR(sideways(false, GetParam(), 1.0), 0.0, 1e-9 * bevel);
}

TEST(BevelledTipInTheNearField, is_drawn_aside_as_far_whatever_the_spacing_of_contacts) {
  const double usual = sideways(true, Bevel::Law::offset, 0.0);
  for (const double spacing_mm : {2.0, 3.0, 6.0, 8.0})
    EXPECT_NEAR(sideways(true, Bevel::Law::offset, 0.0, spacing_mm), usual, 0.05 * usual) << spacing_mm << " mm";
}

INSTANTIATE_TEST_SUITE_P(Laws, TipInTheNearField, testing::Values(Bevel::Law::offset, Bevel::Law::force),
                         [](const auto& tested) { return tested.param == Bevel::Law::offset ? "offset" : "force"; });

}  // namespace
}  // namespace stylet
