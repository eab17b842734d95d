// SPDX-License-Identifier: GPL-3.0-or-later
// A guide template in whole insertions.
#include "needle_in_block.hpp"
#include "stylet/needle/guided.hpp"

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

constexpr double kDistance = 10.0;

BlockOptions guided(double bow_mm = 0.0) {
  BlockOptions options;
  options.cells = {5, 5, 5};
  options.needle_length = 200.0;
  options.needle = [bow_mm](int capacity) -> std::unique_ptr<Needle> {
    NeedleSection section;
    section.bow_mm = bow_mm;
    return std::make_unique<GuidedNeedle>(BeamNeedle::build(section, 24, capacity + 1).value(), GuideHole{}, capacity);
  };
  return options;
}

void aim_through_template(NeedleInBlock& run) {
  const Vec3 entry(2.0, 3.0, 0.0);
  run.insertion->place_guide(entry - kDistance * Vec3::UnitZ(), Vec3::UnitZ());
  run.aim(entry);
}

const GuidedNeedle& needle_of(const NeedleInBlock& run) {
  return dynamic_cast<const GuidedNeedle&>(run.insertion->needle());
}

/// Action and reaction: the forces of hand and guide together equal those of the contacts.
void expect_balance(const NeedleInBlock& run) {
  Vec3 force = run.report.hand_force_N + run.report.guide_force_N;
  Vec3 torque = run.report.torque_Nmm;
  const Needle& needle = run.insertion->needle();
  torque += (needle.point(needle.guide_load().s) - needle.base().origin).cross(needle.guide_load().force);
  for (const ContactState& contact : run.insertion->contacts()) {
    force -= contact.force;
    torque -= (needle.point(std::clamp(contact.s, 0.0, needle.length())) - needle.base().origin).cross(contact.force);
  }
  EXPECT_LT(force.norm(), 1e-9);
  EXPECT_LT(torque.norm(), 1e-7);
}

TEST(Guide, holds_the_shaft_in_an_insertion_and_its_force_is_the_hands_too) {
  NeedleInBlock run(guided());
  aim_through_template(run);
  run.go(25.0);
  run.sideways = Vec3(3.0, 0.0, 0.0);  // a hand that pulls the base aside
  int iterations = 0;
  for (int k = 0; k < 200; ++k) {
    run.sideways.x() = 3.0 * (k + 1) / 200.0;
    run.step(1e-3);
    iterations += run.report.iterations;
    ASSERT_LE(needle_of(run).offset(), 0.05 + 1.01 * run.report.guide_force_N.norm() / 100.0);
    expect_balance(run);
  }
  EXPECT_LT(iterations / 200.0, 6.0);
  EXPECT_GT(run.report.guide_force_N.norm(), 0.05);
  EXPECT_LT(run.report.guide_force_N.x(), 0.0);  // towards the hole
  EXPECT_NEAR(run.report.guide_force_N.dot(needle_of(run).tangent(needle_of(run).guide_load().s)), 0.0, 1e-9);
  EXPECT_EQ(run.flags, 0u);
}

TEST(Guide, holds_a_shaft_that_runs_round_the_edge_of_its_hole) {
  for (const double bow : {0.0, 0.3}) {
    for (const int back : {200, 1200}) {
      SCOPED_TRACE(testing::Message() << "bow " << bow << " mm, back in " << back << " steps");
      NeedleInBlock run(guided(bow));
      aim_through_template(run);
      run.go(45.0);
      int most = 0;
      double largest = 0.0;
      const auto pull = [&](const Vec3& by, int steps) {
        const Vec3 from = run.sideways;
        for (int k = 1; k <= steps; ++k) {
          run.sideways = from + by * static_cast<double>(k) / steps;
          run.step(1e-3);
          most = std::max(most, run.report.iterations);
          largest = std::max(largest, run.report.guide_force_N.norm());
        }
      };
      pull({3.0, 0.0, 0.0}, 200);
      const double once = largest;
      pull({-6.0, 1.0, 0.0}, back);
      EXPECT_EQ(run.flags, 0u);
      EXPECT_LE(most, 12);
      EXPECT_GT(once, 0.1);
      EXPECT_LT(largest, 1.5 * once);
      expect_balance(run);
    }
  }
}

TEST(Guide, keeps_the_shaft_straight_where_the_hands_push_would_bend_it) {
  // The needle is pushed by more than a free needle bears, slightly out of line. With the template, only the 10 mm in
  // front of the skin are free.
  const auto deflection = [](BlockOptions options) {
    NeedleInBlock run(options);
    aim_through_template(run);
    run.sideways = Vec3(0.0, 0.4, 0.0);
    run.insertion->place(run.pose());
    run.go(45.0);
    EXPECT_GT(run.peak(), 0.95);
    EXPECT_EQ(run.flags, 0u);
    return std::abs(run.insertion->contacts().back().position.y() - 3.0);
  };
  BlockOptions free = guided();
  free.needle = [](int capacity) -> std::unique_ptr<Needle> { return BeamNeedle::build({}, 24, capacity).value(); };
  EXPECT_LT(deflection(guided()), 0.5 * deflection(free));
}

TEST(Guide, without_sideways_load_nothing_changes) {
  const auto forces = [](BlockOptions options) {
    options.region_at = [](const Vec3&) { return 0; };
    options.needle_length = 200.0;
    NeedleInBlock run(options);
    aim_through_template(run);
    run.go(20.0);
    run.go(-1.0);
    return run.forces;
  };
  BlockOptions roomy = guided();
  roomy.needle = [](int capacity) -> std::unique_ptr<Needle> {
    return std::make_unique<GuidedNeedle>(BeamNeedle::build({}, 24, capacity + 1).value(), GuideHole{5.0, 100.0},
                                          capacity);
  };
  BlockOptions free = guided();
  free.needle = [](int capacity) -> std::unique_ptr<Needle> { return BeamNeedle::build({}, 24, capacity).value(); };
  EXPECT_EQ(forces(roomy), forces(free));
}

TEST(Guide, a_bowed_needle_leans_on_its_hole_in_the_air_and_comes_out_again) {
  NeedleInBlock run(guided(4.0));
  aim_through_template(run);
  run.step(1e-3);
  EXPECT_GT(run.report.guide_force_N.norm(), 0.005);
  EXPECT_NEAR((run.report.guide_force_N + run.report.hand_force_N).norm(), 0.0, 1e-12);
  run.go(30.0);
  expect_balance(run);
  run.go(-1.0);
  EXPECT_EQ(run.count(EventKind::withdrawn), 1);
  EXPECT_EQ(run.report.tip_state, TipState::air);
  EXPECT_LT(run.report.guide_force_N.norm(), 0.5);
  EXPECT_EQ(run.flags, 0u);
}

}  // namespace
}  // namespace stylet
