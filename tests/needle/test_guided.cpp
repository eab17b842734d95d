// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the hole of a guide template with every needle model.
#include "needle_model_test.hpp"
#include "stylet/needle/guided.hpp"
#include "stylet/needle/theory.hpp"
#include "support/count_allocations.hpp"

#include <cmath>
#include <numbers>

namespace stylet {
namespace {

using test::kEI;
using test::kLength;

class NeedleInAGuide : public test::NeedleModelTest {
 protected:
  [[nodiscard]] static std::unique_ptr<GuidedNeedle> guided(const GuideHole& hole, double at_mm,
                                                            const Vec3& aside = {0, 0, 0}, double bow_mm = 0.0) {
    NeedleSection section;
    section.bow_mm = bow_mm;
    auto built = make_needle(model(), section, 0, 17);
    EXPECT_TRUE(built.ok());
    auto needle = std::make_unique<GuidedNeedle>(std::move(built).value(), hole, 16);
    needle->place_guide(Vec3(0, 0, at_mm) + aside, Vec3::UnitZ());
    return needle;
  }
  /// Allowed relative error of the shaft within `a` of the clamp; rods of a given length represent it less well.
  [[nodiscard]] static double small(double a) {
    const double rod = kLength / elements();
    return model() == "tet" ? 0.04 : (model() == "springs" ? 0.01 + 0.5 * rod * rod / (a * a) : 0.01);
  }
};

// [N/mm] So hard that it stands for the rigid support of theory. Without clearance the edge is not rounded, and a
// harder one would turn the rounding of places into more force than a balance may lack.
constexpr double kHard = 1e6, kHardWithoutClearance = 1e5;

TEST_P(NeedleInAGuide, is_a_propped_cantilever_as_in_theory) {
  constexpr double P = 1e-3;
  for (const double a : {40.0, 75.0, 120.0}) {
    for (const double clearance : {0.0, 0.002}) {
      const auto needle = guided({clearance, kHard}, a);
      test::settle(*needle, std::vector<PointLoad>{{kLength, {0, P, 0}}}, tolerance());
      const double alone = cantilever_deflection(P, kLength, a, kEI);
      const double reaction = (alone - std::min(alone, clearance)) / cantilever_deflection(1.0, a, a, kEI);
      const double tip =
          cantilever_deflection(P, kLength, kLength, kEI) - cantilever_deflection(reaction, a, kLength, kEI);
      EXPECT_NEAR(needle->guide_load().force.y(), -reaction, small(a) * reaction) << a;
      EXPECT_NEAR(needle->guide_load().s, a, 1e-3);
      EXPECT_NEAR(needle->point(kLength).y(), tip, small(a) * tip) << a;
      EXPECT_NEAR(needle->point(a).y(), std::min(alone, clearance), 1e-5) << a;
    }
  }
}

TEST_P(NeedleInAGuide, is_free_inside_the_clearance_and_held_beyond_it) {
  const GuideHole hole{0.3, 100.0};
  const auto with = guided(hole, 60.0);
  const auto without = make();
  for (const double force : {0.002, 0.01, 0.1, 0.4}) {
    const std::vector<PointLoad> loads{{kLength, {force, -0.3 * force, 0}}, {110.0, {0, force, 0}}};
    test::settle(*with, loads, tolerance());
    test::settle(*without, loads, tolerance());
    const double alone = without->point(60.0).head<2>().norm();
    if (alone < hole.clearance_mm) {
      EXPECT_EQ(VecX(with->state()), VecX(without->state()));
      EXPECT_EQ(with->guide_load().force, Vec3(0, 0, 0));
    } else {
      EXPECT_GT(with->offset(), hole.clearance_mm);
      EXPECT_NEAR(with->offset(), hole.clearance_mm + with->guide_load().force.norm() / hole.stiffness_N_per_mm,
                  0.01 * hole.clearance_mm);
    }
  }
  EXPECT_GT(with->guide_load().force.norm(), 0.5);
}

TEST_P(NeedleInAGuide, the_hole_never_pulls_along_the_shaft) {
  const auto needle = guided({0.05, 100.0}, 70.0, {1.0, -2.0, 0.0});
  test::settle(*needle, std::vector<PointLoad>{{kLength, {0.3, 0.1, -0.2}}}, tolerance());
  const PointLoad guide = needle->guide_load();
  EXPECT_GT(guide.force.norm(), 0.1);
  EXPECT_NEAR(guide.force.dot(needle->tangent(guide.s)), 0.0, 1e-12);
}

TEST(BeamInAGuide, hand_guide_and_loads_are_in_balance) {
  // The moment at the clamp, which the hand bears, equals the moment of loads and guide about the base. It is read from
  // the shape: at the clamp, the curvature of the shaft is moment / EI.
  const auto needle = std::make_unique<GuidedNeedle>(test::beam(48), GuideHole{0.05, 100.0}, 16);
  needle->place_guide({0.0, -2.0, 70.0}, Vec3::UnitZ());
  const std::vector<PointLoad> loads{{kLength, {0, 0.2, -0.1}}};
  test::settle(*needle, loads);
  const PointLoad guide = needle->guide_load();
  const Vec3 moment = needle->point(kLength).cross(loads[0].force) + needle->point(guide.s).cross(guide.force);
  const VecX state = needle->state();
  const double curvature =
      1.5 * state[0] - 0.5 * state[3];  // at the clamp, extrapolated from the means of the first two elements
  EXPECT_NEAR(kEI * curvature, moment.x(), 1e-3 * std::abs(moment.x()));
}

TEST_P(NeedleInAGuide, compliance_is_how_equilibrium_positions_follow_the_loads) {
  const auto needle = guided({0.05, 100.0}, 70.0, {0.5, 0.2, 0.0});
  needle->set_base({Vec3(0.1, 0.2, 3.0), Eigen::Quaterniond(Eigen::AngleAxisd(0.01, Vec3::UnitX()))});
  std::vector<PointLoad> loads{{kLength, {0.1, 0.02, -0.1}}, {120.0, {0.05, 0.1, 0}}};
  settle(*needle, loads);
  ASSERT_GT(needle->guide_load().force.norm(), 0.1);
  const MatX compliance = test::compliance_of(*needle, loads);
  const MatX differences = compliance_by_differences(*needle, loads);
  // The part that the tangent neglects, the rotation of the guide's force, is small.
  for (Eigen::Index column = 0; column < compliance.cols(); ++column)
    EXPECT_LT((differences - compliance).col(column).norm(), 2e-3 * compliance.norm()) << column;
}

TEST_P(NeedleInAGuide, a_load_that_is_appended_is_as_if_it_had_been_there) {
  const auto needle = guided({0.05, 100.0}, 70.0, {0.5, 0.2, 0.0});
  const auto other = guided({0.05, 100.0}, 70.0, {0.5, 0.2, 0.0});
  const std::vector<PointLoad> loads{{kLength, {0.1, 0.02, -0.1}}, {120.0, {0.05, 0.1, 0}}, {90.0, {0, 0, 0}}};
  for (GuidedNeedle* n : {needle.get(), other.get()}) settle(*n, std::span(loads).first(2));
  ASSERT_GT(needle->guide_load().force.norm(), 0.1);
  MatX compliance(9, 9);
  VecX free(9);
  MatX expected(9, 9);
  VecX expected_free(9);
  needle->linearise(std::span(loads).first(2), compliance.topLeftCorner(6, 6), free.head(6));
  if (model() == "tet") {  // this model needs a new tangent
    EXPECT_FALSE(needle->append(loads, compliance.bottomRows<3>()));
    return;
  }
  ASSERT_TRUE(needle->append(loads, compliance.bottomRows<3>()));
  ASSERT_TRUE(needle->relax(loads, free));
  other->linearise(loads, expected, expected_free);
  EXPECT_LT((compliance.bottomRows<3>() - expected.bottomRows<3>()).norm(), 1e-11 * expected.norm());
  EXPECT_LT((free - expected_free).norm(), 1e-11 * expected.norm());
}

TEST_P(NeedleInAGuide, is_part_of_a_tangent_that_is_prepared) {
  const auto needle = guided({0.05, 100.0}, 70.0, {0.5, 0.2, 0.0});
  constexpr int kLoads = 15;
  std::vector<PointLoad> loads;
  for (int c = 0; c < kLoads; ++c) loads.push_back({kLength - 6.0 * c, Vec3(0.1, 0.02 * c, -0.1) / kLoads});
  MatX compliance(3 * kLoads, 3 * kLoads);
  MatX expected = compliance;
  VecX free(3 * kLoads);
  VecX expected_free = free;
  needle->linearise({}, compliance.topLeftCorner(0, 0), free.head(0));
  settle(*needle, loads);
  ASSERT_GT(needle->guide_load().force.norm(), 0.1);
  needle->linearise(loads, expected, expected_free);
  ASSERT_EQ(needle->prepares(), model() != "tet");  // the other model makes each tangent at once
  if (!needle->prepares()) return;
  EXPECT_TRUE(needle->prepare(loads, {}, Indefinite::give_up));
  // Meanwhile the tangent in use is recomputed for other loads.
  std::vector<PointLoad> others = loads;
  for (PointLoad& load : others) load.s -= 3.0;
  MatX of_others = expected;
  while (!needle->prepared_compliance(compliance)) needle->linearise(others, of_others, free);
  EXPECT_EQ(compliance, expected);
  needle->take_prepared();
  ASSERT_TRUE(needle->relax(loads, free));
  EXPECT_LT((free - expected_free).norm(), 1e-11 * expected.norm());
}

TEST_P(NeedleInAGuide, with_a_tangent_for_another_stiffness_of_its_hole_it_moves_as_with_a_new_one) {
  // The shaft presses on the rounded edge, whose stiffness changes with the force. The hole is moved between tangent
  // and step, so that the shaft presses less, more, not at all, and in another direction.
  std::vector<PointLoad> loads{{kLength, {0.002, 0.004, 0}}, {120.0, {0.001, 0.002, 0}}};
  for (const Vec3& aside : {Vec3(0, 0.002, 0), Vec3(0, -0.001, 0), Vec3(0.01, 0.0, 0)}) {
    const auto needle = guided({0.05, 100.0}, 70.0);
    const auto other = guided({0.05, 100.0}, 70.0);
    MatX compliance(6, 6);
    VecX free(6);
    for (GuidedNeedle* n : {needle.get(), other.get()}) {
      settle(*n, loads);
      ASSERT_GT(n->guide_load().force.norm(), 1e-3);
      ASSERT_LT(n->guide_load().force.norm(), 1.0);
      n->linearise(loads, compliance, free);
    }
    needle->set_base({aside, Eigen::Quaterniond::Identity()});
    other->set_base({aside, Eigen::Quaterniond::Identity()});
    const MatX old = compliance;
    VecX expected(6);
    ASSERT_TRUE(needle->relax(loads, free));
    other->linearise(loads, compliance, expected);
    EXPECT_LT((free - expected).norm(), 1e-2 * expected.norm());
    EXPECT_GT((compliance - old).norm(), 1e-2 * old.norm()) << "the hole is as stiff as before";
    auto more = loads;
    more.front().force += Vec3(-0.001, 0.002, 0.0);
    const VecX before = needle->state();
    needle->advance(more);
    other->advance(more);
    // The force of the hole has changed as well, and with it a small part of the Hessian.
    EXPECT_LT((needle->state() - other->state()).norm(), 1e-2 * (other->state() - before).norm());
    needle->set_base({Vec3(0, -0.05, 0), Eigen::Quaterniond::Identity()});
    EXPECT_FALSE(needle->relax(loads, free)) << "where nothing holds the shaft any more it needs a new tangent";
  }
}

TEST_P(NeedleInAGuide, holds_the_shaft_against_buckling) {
  // A shaft that is clamped and propped half way bears more than a free one: Euler's load of the free half alone is
  // four times as high, and the two halves turn each other.
  const double euler = std::numbers::pi * std::numbers::pi * kEI / (4.0 * kLength * kLength);
  const auto free = make();
  const auto held = guided({0.0, kHardWithoutClearance}, 100.0);
  MatX compliance(3, 3);
  VecX motion(3);
  const std::vector<PointLoad> loads{{kLength, {0, 0, -1.5 * euler}}};
  settle(*held, loads);
  EXPECT_TRUE(held->linearise(loads, compliance, motion));
  settle(*free, loads);
  EXPECT_FALSE(free->linearise(loads, compliance, motion));
}

TEST_P(NeedleInAGuide, gives_up_on_a_tangent_that_the_hole_does_not_make_definite) {
  const auto needle = guided({0.05, 100.0}, 60.0, {0.4, 0.0, 0.0});
  const std::vector<PointLoad> loads = {{kLength, {0.0, 0.0, -4.0}}, {150.0, {0, 0, -0.2}}};
  const std::vector<Mat3> springs(2, Vec3(0.4, 0.4, 0.0).asDiagonal());
  MatX compliance(6, 6);
  VecX free(6);
  needle->linearise(loads, compliance, free, springs);
  needle->advance(loads);
  ASSERT_GT(needle->guide_load().force.norm(), 0.0);
  const MatX untouched = MatX::Constant(6, 6, 7.0);
  compliance = untouched;
  EXPECT_FALSE(needle->linearise(loads, compliance, free, {}, Indefinite::give_up));
  EXPECT_EQ(compliance, untouched);
  EXPECT_FALSE(needle->relax(loads, free)) << "there is no tangent";
  EXPECT_TRUE(needle->linearise(loads, compliance, free, springs, Indefinite::give_up));
  EXPECT_TRUE(needle->relax(loads, free));
}

TEST_P(NeedleInAGuide, on_springs_beyond_buckling_newton_reaches_the_equilibrium_in_few_steps) {
  const auto needle = guided({0.05, 100.0}, 60.0, {0.4, 0.0, 0.0});
  const std::vector<PointLoad> given = {{kLength, {0.02, 0.01, -4.0}}, {150.0, {0, 0, -0.2}}};
  const std::vector<Mat3> springs(2, Vec3(0.4, 0.4, 0.0).asDiagonal());
  std::vector<PointLoad> loads = given;
  MatX compliance(6, 6);
  VecX free(6);
  const auto hang = [&] {
    for (std::size_t c = 0; c < 2; ++c)
      loads[c].force = given[c].force + springs[c] * (Vec3(0.3, -0.2, given[c].s) - needle->point(given[c].s));
  };
  int iterations = 0;
  for (; iterations < 20; ++iterations) {
    hang();
    if (needle->residual(loads) < 3.0 * tolerance()) break;
    needle->linearise(loads, compliance, free, springs);
    needle->advance(loads);
  }
  EXPECT_LE(iterations, 12);
  EXPECT_GT(needle->guide_load().force.norm(), 0.1);
}

TEST_P(NeedleInAGuide, a_bowed_shaft_is_straightened_by_it) {
  const auto needle = guided({0.0, kHardWithoutClearance}, 120.0, {0, 0, 0}, 5.0);
  EXPECT_NEAR(needle->offset(), 5.0 * 0.36, 0.05);
  settle(*needle, {});
  EXPECT_LT(needle->offset(), 1e-4);
  EXPECT_LT(needle->guide_load().force.x(), 0.0);
  EXPECT_LT(needle->point(kLength).x(), 5.0);
  EXPECT_GT(needle->energy(), 0.0);
}

TEST_P(NeedleInAGuide, nothing_holds_before_the_tip_comes_or_when_the_base_has_passed) {
  for (const double at : {-5.0, 201.0}) {
    const auto needle = guided({0.0, 100.0}, at, {3.0, 0.0, 0.0});
    EXPECT_EQ(settle(*needle, {}), 0);
    EXPECT_EQ(needle->guide_load().force, Vec3(0, 0, 0));
    EXPECT_EQ(needle->offset(), 0.0);
  }
}

TEST_P(NeedleInAGuide, no_call_allocates) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "the heap belongs to a sanitizer";
  const auto needle = guided({0.0, 100.0}, 70.0, {0.5, 0.2, 0.0});
  std::vector<PointLoad> loads;
  for (int c = 0; c < 16; ++c) loads.push_back({80.0 + 7.5 * c, Vec3(0.01, 0.02, -0.01)});
  const std::vector<Mat3> springs(loads.size(), Mat3::Identity());
  MatX compliance(48, 48);
  VecX free(48);
  double sink = 0.0;
  const test::AllocationCount allocations;
  needle->set_base({Vec3(0.1, 0.0, 1.0), Eigen::Quaterniond::Identity()});
  for (int i = 0; i < 3; ++i) {
    needle->linearise(loads, compliance, free);
    needle->advance(loads);
    needle->linearise(loads, compliance, free, springs);
    needle->advance(loads);
    needle->set_base({Vec3(0.1, 1e-3 * i, 1.0), Eigen::Quaterniond::Identity()});
    sink += needle->relax(loads, free) ? 1.0 : 0.0;
    needle->advance(loads);
    sink += needle->residual(loads) + needle->energy() + needle->guide_load().force.x();
  }
  needle->straighten();
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_TRUE(std::isfinite(sink));
}

STYLET_FOR_EVERY_NEEDLE_MODEL(NeedleInAGuide);

}  // namespace
}  // namespace stylet
