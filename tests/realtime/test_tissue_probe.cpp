// SPDX-License-Identifier: GPL-3.0-or-later
// Seeds that are dropped, and points of the tissue that are followed, while the loop runs.
#include "sim/box_patient.hpp"
#include "stylet/realtime/tissue_probe.hpp"
#include "support/count_allocations.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

constexpr double kDt_s = 4e-3;
constexpr double kBeyond_mm = 2.25;

/// A needle that was pushed into the gland and rests there, with a probe that is answered after each step.
struct Pushed {
  Simulation simulation;
  TissueProbe probe;
  Pose base;

  explicit Pushed(double depth_mm) : simulation(test::compiled(scenario())) {
    const PlannedInsertion& plan = simulation.model().insertions()[0];
    double depth = -3.0;
    for (; depth < depth_mm; depth += 0.16) step(plan, depth);
    for (int k = 0; k < 50; ++k) step(plan, depth_mm);
  }
  static Scenario scenario() {
    Scenario s = test::box_scenario();
    s.insertions[0].depth_mm = 40.0;
    return s;
  }
  void step(const PlannedInsertion& plan, double depth_mm) {
    base = pose_along(plan.entry + (depth_mm - 120.0) * plan.direction, plan.direction);
    rest();
  }
  void rest() {
    simulation.prepare();
    simulation.step(base, kDt_s);
    probe.serve(simulation);
  }
  ProbedDrop drop() {
    const std::uint32_t order = probe.order_drop(kBeyond_mm);
    for (int k = 0; k < 100; ++k) {
      rest();
      if (probe.fetch() && probe.answer().order == order && probe.answer().drops[0].is_done) break;
    }
    return probe.answer().drops[0];
  }
};

TEST(TissueProbe, finds_the_point_of_the_tissue_at_which_a_needle_leaves_a_seed) {
  Pushed needle(30.0);
  const ProbedDrop drop = needle.drop();
  ASSERT_TRUE(drop.is_done && drop.tip_in_tissue && drop.found);
  const Needle& shape = needle.simulation.insertion().needle();
  const Vec3 place = shape.point(shape.length()) + kBeyond_mm * shape.tangent(shape.length());
  EXPECT_LT((vec3(drop.place) - place).norm(), 0.02) << "the needle rests, but the tissue still creeps";
  const auto at = needle.simulation.model().locator().find(vec3(drop.rest));
  ASSERT_TRUE(at);
  const auto u = needle.simulation.displacement_at(*at, vec3(drop.rest));
  ASSERT_TRUE(u);
  EXPECT_LT((vec3(drop.rest) + u->whole - vec3(drop.place)).norm(), 0.03);
  EXPECT_GT(u->whole.norm(), 0.1) << "the tissue is displaced, so that this is a test";
}

TEST(TissueProbe, drops_nothing_while_the_tip_is_in_air_or_presses_on_the_skin) {
  for (const double depth : {-3.0, 0.5}) {
    Pushed needle(depth);
    const ProbedDrop drop = needle.drop();
    EXPECT_TRUE(drop.is_done);
    EXPECT_FALSE(drop.tip_in_tissue) << depth;
  }
}

TEST(TissueProbe, leaves_the_seeds_of_a_train_where_they_were_held_as_the_tip_passes_them) {
  Pushed needle(30.0);
  const PlannedInsertion plan = needle.simulation.model().insertions()[0];
  const std::array<double, 2> behind{2.25, 12.25};
  const std::uint32_t order = needle.probe.order_train(behind, kBeyond_mm);
  needle.rest();
  std::array<Vec3, 2> held;
  const Needle& shape = needle.simulation.insertion().needle();
  for (std::size_t k = 0; k < 2; ++k) held[k] = shape.point(shape.length() - behind[k]);
  for (int k = 0; k < 50; ++k) needle.rest();
  needle.probe.fetch();
  ASSERT_EQ(needle.probe.answer().order, order);
  ASSERT_EQ(needle.probe.answer().drop_count, 2u);
  EXPECT_FALSE(needle.probe.answer().drops[0].is_done) << "a needle at rest leaves none";
  double depth = 30.0;
  for (; depth > 10.0; depth -= 0.08) needle.step(plan, depth);
  for (int k = 0; k < 50; ++k) needle.rest();
  needle.probe.fetch();
  for (std::size_t k = 0; k < 2; ++k) {
    const ProbedDrop& drop = needle.probe.answer().drops[k];
    ASSERT_TRUE(drop.is_done && drop.found) << k;
    EXPECT_LT((vec3(drop.place) - held[k]).norm(), 0.02) << "the stylet holds it while the needle moves";
    // The needle is nearly straight: its tip was at the seed's end.
    EXPECT_NEAR(drop.base_depth_mm, 30.0 - behind[k] - kBeyond_mm, 0.3);
  }
  EXPECT_LT(needle.probe.answer().drops[0].time_s, needle.probe.answer().drops[1].time_s);
}

TEST(TissueProbe, a_train_that_is_called_off_leaves_no_further_seed) {
  Pushed needle(30.0);
  const PlannedInsertion plan = needle.simulation.model().insertions()[0];
  const std::array<double, 1> behind{2.25};
  needle.probe.order_train(behind, kBeyond_mm);
  needle.rest();
  const std::uint32_t none = needle.probe.order_train({}, kBeyond_mm);
  for (double depth = 30.0; depth > 20.0; depth -= 0.16) needle.step(plan, depth);
  needle.probe.fetch();
  EXPECT_EQ(needle.probe.answer().order, none);
  EXPECT_EQ(needle.probe.answer().drop_count, 0u);
}

TEST(TissueProbe, follows_points_as_the_tissue_moves) {
  Pushed needle(30.0);
  const std::vector<Vec3> points{{4, 7, 20}, {4, 8, 32}, {6, 7, 25}};
  const std::uint32_t version = needle.probe.watch(points);
  for (int k = 0; k < 40; ++k) needle.rest();
  needle.probe.fetch();
  const TissueProbe::Answer& answer = needle.probe.answer();
  ASSERT_EQ(answer.version, version);
  ASSERT_EQ(answer.count, points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    ASSERT_TRUE(answer.is_known[k]);
    const auto u = needle.simulation.displacement_at(*needle.simulation.model().locator().find(points[k]), points[k]);
    ASSERT_TRUE(u);
    EXPECT_LT((vec3(answer.now[k]) - points[k] - u->whole).norm(), 0.02);
  }
}

TEST(TissueProbe, answers_without_allocating) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "allocations cannot be counted here";
  Pushed needle(30.0);
  const std::vector<Vec3> points{{4, 7, 20}, {4, 8, 32}};
  needle.probe.watch(points);
  needle.probe.order_drop(kBeyond_mm);
  for (int k = 0; k < 100; ++k) {
    needle.simulation.prepare();
    needle.simulation.step(needle.base, kDt_s);
    const test::AllocationCount allocations;
    needle.probe.serve(needle.simulation);
    ASSERT_EQ(allocations.count(), 0) << "step " << k;
  }
  needle.probe.fetch();
  EXPECT_TRUE(needle.probe.answer().drops[0].is_done);
}

}  // namespace
}  // namespace stylet
