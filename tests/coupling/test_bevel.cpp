// SPDX-License-Identifier: GPL-3.0-or-later
// How a bevelled tip changes the needle's path through tissue.
#include "mirrored_block.hpp"
#include "needle_in_block.hpp"

#include <numbers>

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kDepth = 60.0;

/// Tissue of one soft medium, so that only the tip turns the needle.
BlockOptions tissue(double bevel_deg, Bevel::Law law = Bevel::Law::offset) {
  BlockOptions options;
  options.cells = {5, 5, 6};
  options.regions = {"body"};
  options.region_at = [](const Vec3&) { return 0; };
  options.materials = {{0.03, 0.45}};
  options.laws = {{0.35, 0.5, {18e-3, 11e-3, 250e-6}, false, true, -1}};
  options.coupling.method = CouplingSettings::Method::embedded;
  options.coupling.spacing_mm = 8.0;
  options.coupling.bevel.angle_rad = bevel_deg * kDegree;
  options.coupling.bevel.law = law;
  return options;
}

/// Distance of the tip from the axis [mm] at every step.
std::vector<Vec3> way(const BlockOptions& options, double roll_deg = 0.0, double dt = 2e-3, double turned_at = 1e9) {
  NeedleInBlock run(options);
  run.roll = roll_deg * kDegree;
  const Vec3 entry(1.0, 2.0, 0.0);
  run.aim(entry);
  std::vector<Vec3> offsets;
  const auto advance = [&](double to) {
    while (run.depth < to - 1e-9) {
      run.depth += 20.0 * dt;
      run.step(dt);
      const Vec3 off = run.report.tip_mm - entry;
      offsets.emplace_back(off.x(), off.y(), 0.0);
    }
  };
  advance(std::min(turned_at, kDepth));
  if (turned_at < kDepth) {
    for (int k = 0; k < 100; ++k) {
      run.roll += std::numbers::pi / 100;
      run.step(dt);
    }
    advance(kDepth);
  }
  EXPECT_EQ(run.flags & ~Step::contact_cycling, 0u);
  return offsets;
}

/// Deflection of the tip by the bevel alone: the deflection of a symmetric tip, by mesh and friction, is subtracted.
Vec3 drawn(const BlockOptions& options, double roll_deg = 0.0, double dt = 2e-3) {
  BlockOptions symmetric = options;
  symmetric.coupling.bevel.angle_rad = 0.0;
  return way(options, roll_deg, dt).back() - way(symmetric, 0.0, dt).back();
}

class BevelledTip : public testing::TestWithParam<Bevel::Law> {};

TEST_P(BevelledTip, is_drawn_to_its_sharp_side_and_the_deflection_turns_with_the_roll) {
  const Vec3 at_zero = drawn(tissue(25.0, GetParam()));
  EXPECT_GT(at_zero.x(), GetParam() == Bevel::Law::offset ? 0.3 : 0.03);
  EXPECT_LT(std::abs(at_zero.y()), 0.15 * at_zero.x());
  for (const double roll : {90.0, 180.0, -45.0}) {
    const Vec3 turned = Eigen::AngleAxisd(roll * kDegree, Vec3::UnitZ()) * at_zero;
    EXPECT_LT((drawn(tissue(25.0, GetParam()), roll) - turned).norm(), 0.2 * at_zero.norm()) << roll;
  }
}

TEST_P(BevelledTip, a_half_turn_half_way_makes_an_s) {
  const auto s = way(tissue(25.0, GetParam()), 0.0, 2e-3, kDepth / 2);
  const auto straight_on = way(tissue(25.0, GetParam()));
  const auto symmetric = way(tissue(0.0, GetParam()));
  const std::size_t half = s.size() / 2;
  const auto bent = [&](const std::vector<Vec3>& w, std::size_t k) { return w[k].x() - symmetric[k].x(); };
  // Before the turn both paths are the same. After it the path bends back: its slope at the end is smaller than half
  // way.
  EXPECT_NEAR(bent(s, half - 1), bent(straight_on, half - 1), 1e-9);
  const std::size_t last = s.size() - 1;
  const std::size_t stretch = half / 4;
  const auto slope = [&](const std::vector<Vec3>& w, std::size_t k) { return bent(w, k) - bent(w, k - stretch); };
  EXPECT_GT(slope(s, half - 1), 0.0);
  EXPECT_GT(slope(straight_on, last), slope(straight_on, half - 1));
  EXPECT_LT(slope(s, last), 0.0);
  EXPECT_LT(bent(s, last), 0.7 * bent(straight_on, last));
}

TEST_P(BevelledTip, does_not_depend_on_the_time_step) {
  const Vec3 fine = drawn(tissue(25.0, GetParam()), 0.0, 5e-4);
  const Vec3 coarse = drawn(tissue(25.0, GetParam()), 0.0, 2e-3);
  EXPECT_LT((coarse - fine).norm(), 0.01 * fine.norm());
}

TEST_P(BevelledTip, hardly_depends_on_the_spacing_of_contacts) {
  // Elements as large as the spacing, and a node for every contact.
  const auto at_spacing = [](double spacing) {
    BlockOptions options = tissue(25.0, GetParam());
    options.cells = {12, 12, 12};
    options.coupling.method = CouplingSettings::Method::node_addition;
    options.coupling.spacing_mm = spacing;
    return drawn(options).x();
  };
  const double usual = at_spacing(6.0);
  for (const double spacing : {4.0, 8.0}) EXPECT_NEAR(at_spacing(spacing), usual, 0.2 * usual) << spacing;
}

TEST_P(BevelledTip, solvers_in_turn_and_in_one_system_agree) {
  BlockOptions options = tissue(25.0, GetParam());
  const auto coupled = way(options, 30.0);
  options.coupling.solver = CouplingSettings::Solver::staggered;
  const auto staggered = way(options, 30.0);
  ASSERT_EQ(coupled.size(), staggered.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < coupled.size(); ++k) largest = std::max(largest, (coupled[k] - staggered[k]).norm());
  EXPECT_LT(largest, 1e-5);
}

TEST_P(BevelledTip, leaves_action_and_reaction_equal) {
  NeedleInBlock run(tissue(25.0, GetParam()));
  run.aim({1, 2, 0});
  run.go(40.0);
  Vec3 sum = Vec3::Zero();
  for (const ContactState& contact : run.insertion->contacts()) sum += contact.force;
  EXPECT_LT((sum - run.report.hand_force_N).norm(), 1e-12);
  const ContactCompliance::Nodes nodes = run.insertion->nodes();
  Vec3 held = Vec3::Zero();
  for (std::size_t k = 0; k < nodes.position.size(); ++k)
    held += nodes.support.segment<3>(3 * static_cast<Index>(k)) + nodes.load.segment<3>(3 * static_cast<Index>(k));
  EXPECT_LT(held.norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Laws, BevelledTip, testing::Values(Bevel::Law::offset, Bevel::Law::force),
                         [](const auto& tested) { return tested.param == Bevel::Law::offset ? "offset" : "force"; });

TEST(BevelOffset, more_bevel_draws_more) {
  double last = 0.0;
  for (const double angle : {5.0, 15.0, 30.0}) {
    const double now = drawn(tissue(angle)).x();
    EXPECT_GT(now, 1.5 * last);
    last = now;
  }
  // At small angles the deflection is proportional to the angle, without a jump at zero.
  EXPECT_NEAR(drawn(tissue(1.0)).x() / drawn(tissue(2.0)).x(), 0.5, 0.05);
}

TEST(BevelForce, the_tip_is_pushed_by_its_share_of_the_axial_force) {
  NeedleInBlock run(tissue(20.0, Bevel::Law::force));
  run.aim({1, 2, 0});
  run.go(50.0);
  const ContactState tip = run.insertion->contacts().front();
  ASSERT_TRUE(tip.tip);
  const Needle& needle = run.insertion->needle();
  const Vec3 t = needle.tangent(needle.length());
  const Vec3 side = Bevel::sharp_side(needle.base(), t);
  EXPECT_GT(tip.force.dot(t), 0.3);
  EXPECT_NEAR(tip.force.dot(side), -0.06 * tip.force.dot(t), 1e-5);
  EXPECT_NEAR(tip.force.dot(t.cross(side)), 0.0, 1e-5);
}

BlockOptions symmetric_block(double bevel_deg, Bevel::Law law = Bevel::Law::offset) {
  BlockOptions options = tissue(bevel_deg, law);
  options.lo = {0, -50, 0};
  options.cells = {3, 5, 6};
  options.edit = test::mirror;
  return options;
}

double sideways(const BlockOptions& options, double roll_deg) {
  NeedleInBlock run(options);
  run.roll = roll_deg * kDegree;
  run.aim({0.0, 2.0, 0.0});
  run.go(50.0, 20.0, 2e-3);
  return run.report.tip_mm.x();
}

TEST(SymmetricTip, goes_straight_in_a_symmetric_block_whatever_the_roll_and_the_law) {
  for (const Bevel::Law law : {Bevel::Law::offset, Bevel::Law::force}) {
    for (const double roll : {0.0, 65.0}) EXPECT_NEAR(sideways(symmetric_block(0.0, law), roll), 0.0, 1e-7) << roll;
    EXPECT_GT(sideways(symmetric_block(20.0, law), 0.0), 0.02);
    EXPECT_LT(sideways(symmetric_block(20.0, law), 180.0), -0.02);
  }
}

}  // namespace
}  // namespace stylet
