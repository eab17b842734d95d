// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the properties on which the rest of the program relies, with every needle model.
#include "needle_model_test.hpp"
#include "support.hpp"
#include "support/count_allocations.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>

namespace stylet {
namespace {

using test::kLength;

std::vector<PointLoad> spread_loads(int count) {
  std::vector<PointLoad> loads;
  for (int c = 0; c < count; ++c) {
    const double phase = 0.7 * c;
    loads.push_back(
        {kLength * (c + 0.5) / count, Vec3(0.4 * std::cos(phase), 0.4 * std::sin(phase) + 0.2, -0.1) / count});
  }
  return loads;
}

class NeedleContract : public test::NeedleModelTest {};

Pose somewhere() {
  return {Vec3(310.0, -95.0, 720.0), Eigen::Quaterniond(Eigen::AngleAxisd(2.1, Vec3(0.2, 0.9, -0.4).normalized()))};
}

TEST_P(NeedleContract, moving_base_and_loads_together_moves_the_solution_rigidly) {
  const auto fixed = make();
  const auto moved = make();
  const Pose pose = somewhere();
  const auto loads = spread_loads(11);
  auto turned = loads;
  for (PointLoad& load : turned) load.force = pose.rotation * load.force;
  settle(*fixed, loads);
  moved->set_base(pose);
  settle(*moved, turned);
  for (double s = -10.0; s <= kLength; s += 7.0) {
    EXPECT_LT((moved->point(s) - (pose.rotation * fixed->point(s) + pose.origin)).norm(), 1e-10 * kLength) << s;
    EXPECT_LT((moved->tangent(s) - pose.rotation * fixed->tangent(s)).norm(), 1e-10) << s;
  }
  EXPECT_NEAR(moved->energy(), fixed->energy(), 1e-10 * fixed->energy());
  const MatX here = test::compliance_of(*fixed, loads);
  const MatX there = test::compliance_of(*moved, turned);
  const Mat3 R = pose.rotation.toRotationMatrix();
  EXPECT_LT((there.block<3, 3>(6, 27) - R * here.block<3, 3>(6, 27) * R.transpose()).norm(),
            (model() == "tet" ? 1e-9 : 1e-10) * here.norm());
}

TEST_P(NeedleContract, setting_the_base_keeps_the_shape) {
  const auto needle = make();
  settle(*needle, spread_loads(5));
  const Vec3 tip = needle->point(kLength);
  const VecX state = needle->state();
  needle->set_base(somewhere());
  EXPECT_EQ(state, VecX(needle->state()));
  EXPECT_LT((needle->point(kLength) - (somewhere().rotation * tip + somewhere().origin)).norm(), 1e-12 * 1000);
  EXPECT_EQ(needle->base().origin, somewhere().origin);
}

TEST_P(NeedleContract, compliance_is_how_equilibrium_positions_follow_the_loads) {
  const auto needle = make();
  needle->set_base(somewhere());
  const auto loads = spread_loads(6);
  settle(*needle, loads);
  const MatX compliance = test::compliance_of(*needle, loads);
  const MatX differences = compliance_by_differences(*needle, loads);
  for (Eigen::Index column = 0; column < compliance.cols(); ++column)
    EXPECT_LT((differences - compliance).col(column).norm(), 2e-6 * compliance.norm()) << column;
}

TEST_P(NeedleContract, free_motion_and_compliance_foretell_the_step_to_first_order) {
  const auto needle = make();
  auto loads = spread_loads(4);
  settle(*needle, loads);
  MatX compliance(12, 12);
  VecX free(12);
  auto changed = loads;
  double previous = 0.0;
  const VecX state = needle->state();
  for (const double size : {1e-2, 1e-3}) {
    needle->set_state(state);
    auto off = loads;
    for (PointLoad& load : off) load.force *= 1.0 + size;
    needle->linearise(off, compliance, free);
    VecX before(12);
    VecX df(12);
    for (int c = 0; c < 4; ++c) {
      before.segment<3>(3 * c) = needle->point(loads[c].s);
      df.segment<3>(3 * c) = size * Vec3(0.1, -0.2 * c, 0.05);
      changed[c].force = off[c].force + df.segment<3>(3 * c);
    }
    const VecX foretold = free + compliance * df;
    needle->advance(changed);
    VecX moved(12);
    for (int c = 0; c < 4; ++c) moved.segment<3>(3 * c) = needle->point(loads[c].s) - before.segment<3>(3 * c);
    const double error = (moved - foretold).norm() / foretold.norm();
    EXPECT_LT(error, 2.0 * size);
    // Where points are linear in the unknowns, as with tetrahedra, the predicted motion is exact.
    if (previous > 1e-8) {
      EXPECT_NEAR(previous / error, 10.0, 2.0);
    }
    previous = error;
  }
}

TEST_P(NeedleContract, newton_converges_quadratically) {
  const auto needle = make();
  const auto loads = spread_loads(9);
  MatX compliance(27, 27);
  VecX free(27);
  std::vector<double> residuals;
  for (int i = 0; i < 12 && (residuals.empty() || residuals.back() > tolerance()); ++i) {
    needle->linearise(loads, compliance, free);
    needle->advance(loads);
    residuals.push_back(needle->residual(loads));
  }
  ASSERT_LE(residuals.back(), tolerance());
  if (model() == "tet") return;  // it passes through stretched shapes, see TetNeedle.newton_converges_quadratically
  // Near the solution, at least one step squares the size of the residual (moments here are tens of N mm).
  bool near = false;
  for (std::size_t i = 1; i < residuals.size(); ++i) {
    if (residuals[i - 1] < 0.1 && residuals[i] > 1e-10) {
      near = true;
      EXPECT_LT(residuals[i], residuals[i - 1] * residuals[i - 1]) << i;
    }
  }
  EXPECT_TRUE(near || residuals.size() <= 6);
}

TEST_P(NeedleContract, relaxing_at_the_shape_and_loads_of_the_tangent_changes_nothing) {
  const auto needle = make();
  const auto other = make();
  needle->set_base(somewhere());
  other->set_base(somewhere());
  const auto loads = spread_loads(6);
  settle(*needle, loads);
  settle(*other, loads);
  auto off = loads;
  for (PointLoad& load : off) load.force *= 1.1;
  MatX compliance(18, 18);
  VecX free(18);
  VecX again(18);
  needle->linearise(off, compliance, free);
  other->linearise(off, compliance, again);
  ASSERT_TRUE(other->relax(off, again));
  EXPECT_LT((again - free).norm(), 1e-9 * free.norm());
  needle->advance(loads);
  other->advance(loads);
  EXPECT_LT((needle->state() - other->state()).norm(), 1e-9 * needle->state().norm());
}

TEST_P(NeedleContract, relaxing_converges_to_the_equilibrium_of_other_loads_at_other_places_under_the_old_tangent) {
  const auto needle = make();
  const auto loads = spread_loads(6);
  settle(*needle, loads);
  MatX compliance(18, 18);
  VecX free(18);
  needle->linearise(loads, compliance, free);
  auto changed = loads;
  // Tetrahedra that turn with an old tangent stretch, and stretching is stiff, so they get a change that is a hundred
  // times smaller.
  const double size = model() == "tet" ? 1e-4 : 1e-2;
  for (PointLoad& load : changed) load = {load.s - 50.0 * size, (1.0 + 2.0 * size) * load.force};
  const auto exact = make();
  settle(*exact, changed);
  int rounds = 0;
  while (needle->residual(changed) > tolerance() && rounds < 40) {
    ASSERT_TRUE(needle->relax(changed, free));
    needle->advance(changed);
    ++rounds;
  }
  EXPECT_LT(rounds, 40);
  EXPECT_GT(rounds, 0);
  EXPECT_LT((needle->point(kLength) - exact->point(kLength)).norm(), 1e-8);
  VecX more(21);
  EXPECT_FALSE(needle->relax(spread_loads(7), more)) << "one that the tangent does not know";
}

TEST_P(NeedleContract, relaxing_under_the_first_loads_only_is_the_same_as_if_there_had_been_no_others) {
  const auto needle = make();
  const auto other = make();
  const auto loads = spread_loads(6);
  const std::vector<PointLoad> first(loads.begin(), loads.begin() + 4);
  for (Needle* n : {needle.get(), other.get()}) settle(*n, first);
  std::vector<PointLoad> unloaded = first;
  unloaded.push_back({loads[4].s, Vec3::Zero()});
  unloaded.push_back({loads[5].s, Vec3::Zero()});
  auto off = first;
  for (PointLoad& load : off) load.force *= 1.01;
  MatX compliance(18, 18);
  MatX expected(12, 12);
  VecX free(18);
  VecX expected_free(12);
  needle->linearise(unloaded, compliance, free);
  other->linearise(off, expected, expected_free);
  ASSERT_TRUE(needle->relax(off, free.head(12)));
  // Loads of a different size change the tangent slightly.
  EXPECT_LT((free.head(12) - expected_free).norm(), 0.05 * expected_free.norm());
  EXPECT_LT((compliance.topLeftCorner(12, 12) - expected).norm(), 0.05 * expected.norm());
  needle->advance(first);
  other->advance(first);
  EXPECT_LT((needle->point(kLength) - other->point(kLength)).norm(), 1e-3);
}

TEST_P(NeedleContract, a_load_that_is_appended_is_as_if_it_had_been_there) {
  const auto needle = make();
  const auto other = make();
  const auto loads = spread_loads(6);
  const std::span<const PointLoad> all(loads);
  for (Needle* n : {needle.get(), other.get()}) {
    n->set_base(somewhere());
    settle(*n, all.first(5));
  }
  auto unloaded = loads;
  unloaded.back().force.setZero();
  MatX compliance(18, 18);
  MatX expected(18, 18);
  VecX free(18);
  VecX expected_free(18);
  // There were seven loads; the last two are dropped, then one is added.
  auto seven = unloaded;
  seven.back() = {31.0, Vec3::Zero()};
  seven.push_back({77.0, Vec3::Zero()});
  MatX larger(21, 21);
  VecX larger_free(21);
  needle->linearise(seven, larger, larger_free);
  if (model() == "tet") {  // this model needs a new tangent
    EXPECT_FALSE(needle->append(unloaded, compliance.bottomRows<3>()));
    return;
  }
  ASSERT_TRUE(needle->append(unloaded, compliance.bottomRows<3>()));
  other->linearise(unloaded, expected, expected_free);
  EXPECT_LT((compliance.bottomRows<3>() - expected.bottomRows<3>()).norm(), 1e-12 * expected.bottomRows<3>().norm());
  ASSERT_TRUE(needle->relax(unloaded, free));
  EXPECT_LT((free - expected_free).norm(), 1e-12 * expected.norm());
  needle->advance(loads);
  other->advance(loads);
  EXPECT_LT((needle->state() - other->state()).norm(), 1e-11 * other->state().norm());
  MatX two(3, 24);
  EXPECT_FALSE(needle->append(spread_loads(8), two)) << "two at once";
}

TEST_P(NeedleContract, a_tangent_that_is_prepared_changes_nothing_until_it_is_taken) {
  const auto needle = make();
  const auto other = make();
  const auto loads = spread_loads(20);
  MatX compliance(60, 60);
  VecX free(60);
  VecX old_free(60);
  for (Needle* n : {needle.get(), other.get()}) {
    n->set_base(somewhere());
    n->linearise(loads, compliance, free);
    n->advance(loads);
  }
  if (!needle->prepares()) {
    EXPECT_EQ(model(), "tet");  // this model makes each tangent at once
    return;
  }
  MatX prepared(60, 60);
  EXPECT_TRUE(needle->prepare(loads, {}, Indefinite::give_up));
  int pieces = 1;
  while (!needle->prepared_compliance(prepared)) ++pieces;
  EXPECT_LT(pieces, 10);
  ASSERT_TRUE(needle->relax(loads, free));
  ASSERT_TRUE(other->relax(loads, old_free));
  EXPECT_EQ(free, old_free);
  needle->take_prepared();
  ASSERT_TRUE(needle->relax(loads, free));
  other->linearise(loads, compliance, old_free);
  EXPECT_EQ(prepared, compliance);
  EXPECT_LT((free - old_free).norm(), 1e-12 * compliance.norm());
  needle->advance(spread_loads(20));
  other->advance(spread_loads(20));
  EXPECT_LT((needle->state() - other->state()).norm(), 1e-12 * other->state().norm());
}

TEST_P(NeedleContract, elastic_energy_is_the_work_of_slowly_applied_loads) {
  const auto needle = make();
  const auto full = spread_loads(7);
  // Simpson's rule for W = ∫ f(t)·du with f = t f₁, integrated by parts: W = f₁·u₁ - ∫ f₁·u dt.
  constexpr int intervals = 64;
  double integral = 0.0;
  double last = 0.0;
  for (int i = 0; i <= intervals; ++i) {
    auto loads = full;
    for (PointLoad& load : loads) load.force *= static_cast<double>(i) / intervals;
    settle(*needle, loads);
    double virtual_work = 0.0;
    for (const PointLoad& load : full) virtual_work += load.force.dot(needle->point(load.s) - Vec3(0, 0, load.s));
    const double weight = i == 0 || i == intervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    integral += weight * virtual_work / (3.0 * intervals);
    last = virtual_work;
  }
  EXPECT_GT(needle->energy(), 0.1);
  EXPECT_NEAR(last - integral, needle->energy(), 1e-7 * needle->energy());
}

TEST_P(NeedleContract, tangent_is_continuous_unit_length_and_the_derivative_of_the_point) {
  // Rods preserve their own length, not the length of the curve through their joints.
  const double stretch = model() == "beam" ? 1e-8 : 1e-3;
  const auto needle = make();
  settle(*needle, std::vector<PointLoad>{{kLength, {0.9, 0.5, 0.2}}, {70.0, {-2.0, 0.4, 0.0}}});
  for (int e = 0; e <= elements(); ++e) {
    const double s = kLength * e / elements();
    EXPECT_LT((needle->tangent(s + 1e-9) - needle->tangent(s - 1e-9)).norm(), 1e-9) << s;
    EXPECT_LT((needle->point(s + 1e-9) - needle->point(s - 1e-9)).norm(), 4e-9) << s;
  }
  for (double s = 1.0; s < kLength - 1.0; s += 3.7) {
    const Vec3 slope = (needle->point(s + 2e-5) - needle->point(s - 2e-5)) / 4e-5;
    EXPECT_NEAR(slope.norm(), 1.0, stretch) << s;
    EXPECT_LT((slope.normalized() - needle->tangent(s)).norm(), 1e-8) << s;
    EXPECT_NEAR(needle->tangent(s).norm(), 1.0, 1e-13);
  }
}

TEST_P(NeedleContract, loads_at_and_before_the_clamp_do_nothing) {
  const auto with = make();
  const auto without = make();
  const std::vector<PointLoad> tip = {{kLength, {0.3, 0.1, -0.2}}};
  std::vector<PointLoad> all = tip;
  all.push_back({0.0, {5.0, -9.0, 3.0}});
  all.push_back({-12.0, {50.0, 20.0, 1.0}});
  settle(*without, tip);
  settle(*with, all);
  EXPECT_EQ(VecX(with->state()), VecX(without->state()));
  EXPECT_EQ(with->residual(all), with->residual(tip));
  const MatX compliance = test::compliance_of(*with, all);
  EXPECT_EQ(compliance.bottomRows(6).norm(), 0.0);
  EXPECT_EQ(compliance.rightCols(6).norm(), 0.0);
  EXPECT_EQ(with->point(-12.0), Vec3(0, 0, -12.0));
}

TEST_P(NeedleContract, no_loads_at_all_leaves_a_straight_needle_straight) {
  const auto needle = make();
  EXPECT_EQ(settle(*needle, {}), 0);
  needle->set_state(VecX::Constant(needle->state().size(), 1e-3));
  settle(*needle, {});
  EXPECT_LT((needle->point(kLength) - Vec3(0, 0, kLength)).norm(), 1e-9);
}

TEST_P(NeedleContract, state_and_straighten_restore_the_shape_exactly) {
  const auto needle = make();
  settle(*needle, spread_loads(3));
  const VecX saved = needle->state();
  const Vec3 tip = needle->point(kLength);
  needle->straighten();
  EXPECT_EQ(needle->energy(), 0.0);
  EXPECT_LT((needle->point(kLength) - Vec3(0, 0, kLength)).norm(), 1e-12 * kLength);
  needle->set_state(saved);
  EXPECT_EQ(needle->point(kLength), tip);
}

TEST_P(NeedleContract, no_call_after_build_allocates) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "the heap belongs to a sanitizer";
  for (const int elements : {4, 24, 120}) {
    for (const int count : {1, 7, 40}) {
      const auto needle = make(elements, 40);
      auto loads = spread_loads(count);
      MatX compliance(3 * count, 3 * count);
      VecX free(3 * count);
      VecX state = needle->state();
      const Pose pose = somewhere();
      double sink = 0.0;
      const std::vector<Mat3> springs(loads.size(), Mat3::Identity());
      const test::AllocationCount allocations;
      needle->set_base(pose);
      for (int i = 0; i < 3; ++i) {
        needle->linearise(loads, compliance, free);
        for (PointLoad& load : loads) load.force *= 1.1;
        needle->advance(loads);
        sink += needle->residual(loads) + needle->energy() + needle->point(33.0).x() + needle->tangent(44.0).x();
      }
      needle->linearise(loads, compliance, free, springs);
      needle->damp(2.0);
      needle->linearise(loads, compliance, free);
      needle->damp(0.0);
      // Also beyond the buckling load.
      loads.back().force = pose.rotation * Vec3(0.1, 0.0, -50.0);
      needle->linearise(loads, compliance, free);
      needle->advance(loads);
      state = needle->state();
      needle->set_state(state);
      needle->straighten();
      EXPECT_EQ(allocations.count(), 0) << elements << " elements, " << count << " loads";
      EXPECT_TRUE(std::isfinite(sink));
    }
  }
}

TEST(AllocationCount, sees_malloc_new_eigen_and_what_is_given_back) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "the heap belongs to a sanitizer";
  // Called through volatile pointers, so that the compiler cannot remove the pairs of calls.
  void* (*volatile allocate)(std::size_t) = std::malloc;
  void (*volatile release)(void*) = std::free;
  void* (*volatile make)(std::size_t) = ::operator new;
  void (*volatile destroy)(void*) = ::operator delete;
  const test::AllocationCount allocations;
  void* block = allocate(8);
  EXPECT_EQ(allocations.count(), 1);
  release(block);
  EXPECT_EQ(allocations.count(), 2);
  release(nullptr);
  EXPECT_EQ(allocations.count(), 2);
  block = make(8);
  EXPECT_EQ(allocations.count(), 3);
  destroy(block);
  EXPECT_EQ(allocations.count(), 4);
  const volatile Eigen::Index size = 10;
  {
    const MatX matrix = MatX::Zero(size, size);
    EXPECT_EQ(allocations.count(), 5);
    EXPECT_EQ(matrix.sum(), 0.0);
  }
  EXPECT_EQ(allocations.count(), 6);
}

TEST(FindEquilibrium, says_what_is_left_and_what_to_do_when_it_cannot_converge) {
  const auto needle = test::beam();
  const auto result = find_equilibrium(*needle, std::vector<PointLoad>{{kLength, {5.0, 0, 0}}}, 1e-9, 1);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, ErrorKind::failed);
  EXPECT_NE(result.error().message().find("N mm"), std::string::npos);
  EXPECT_FALSE(result.error().cure.empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(find_equilibrium(*needle, std::vector<PointLoad>{{kLength, {nan, 0, 0}}}).ok());
}

TEST_P(NeedleContract, equilibrium_under_strong_loads_is_reached_from_the_straight_needle_and_kept_warm) {
  const auto needle = make();
  std::vector<PointLoad> loads = {{kLength, {20.0, 3.0, -8.0}}, {90.0, {-11.0, 6.0, 2.0}}};
  test::settle(*needle, loads, 1e-8);
  EXPECT_EQ(test::settle(*needle, loads, 1e-8), 0);
  loads[0].force.y() += 1e-3;
  EXPECT_LE(test::settle(*needle, loads, 1e-8), 4);
}

/// A needle pressed beyond its own buckling load and held by springs at load points along its shaft.
struct Held {
  std::vector<PointLoad> loads = {{kLength, {0.02, 0.01, -3.0}}, {150.0, {0, 0, -0.2}}, {83.0, {0.01, 0, 0}}};
  std::vector<Mat3> springs = std::vector<Mat3>(3, Vec3(0.4, 0.4, 0.0).asDiagonal());
};

TEST_P(NeedleContract, on_springs_it_is_definite_beyond_buckling) {
  const auto needle = make();
  const Held held;
  MatX compliance(9, 9);
  VecX free(9);
  // The force is applied to the shape first: tetrahedra buckle under the stress they have, not under a load to come.
  auto push = held.loads;
  for (PointLoad& load : push) load.force.head<2>().setZero();
  needle->linearise(push, compliance, free);
  needle->advance(push);
  EXPECT_FALSE(needle->linearise(held.loads, compliance, free));
  EXPECT_GE(compliance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-9);
  EXPECT_TRUE(needle->linearise(held.loads, compliance, free, held.springs));
  EXPECT_GE(compliance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-9);
}

TEST_P(NeedleContract, giving_up_on_an_indefinite_tangent_leaves_the_next_one_as_it_would_be) {
  const auto needle = make();
  const auto other = make();
  const Held held;
  auto push = held.loads;
  for (PointLoad& load : push) load.force.head<2>().setZero();
  MatX compliance(9, 9);
  VecX free(9);
  for (Needle* each : {needle.get(), other.get()}) {
    each->linearise(push, compliance, free);
    each->advance(push);
  }
  const MatX untouched = MatX::Constant(9, 9, 7.0);
  compliance = untouched;
  free.setConstant(7.0);
  EXPECT_FALSE(needle->linearise(held.loads, compliance, free, {}, Indefinite::give_up));
  EXPECT_EQ(compliance, untouched);
  EXPECT_EQ(free, untouched.col(0));
  EXPECT_FALSE(needle->relax(held.loads, free)) << "there is no tangent";

  MatX expected(9, 9);
  VecX expected_free(9);
  ASSERT_TRUE(other->linearise(held.loads, expected, expected_free, held.springs));
  EXPECT_TRUE(needle->linearise(held.loads, compliance, free, held.springs, Indefinite::give_up));
  EXPECT_EQ(compliance, expected);
  EXPECT_EQ(free, expected_free);
}

TEST_P(NeedleContract, compliance_on_springs_is_that_of_the_needle_and_the_springs_together) {
  // Below the buckling load both compliances exist, with (N⁻¹ + G)⁻¹ = (I + N G)⁻¹ N.
  const auto needle = make();
  const Held held;
  auto loads = held.loads;
  for (PointLoad& load : loads) load.force *= 0.1;
  settle(*needle, loads);
  loads[2].force.y() += 0.003;  // not in equilibrium
  MatX alone(9, 9);
  MatX compliance(9, 9);
  VecX free_alone(9);
  VecX free(9);
  ASSERT_TRUE(needle->linearise(loads, alone, free_alone));
  ASSERT_TRUE(needle->linearise(loads, compliance, free, held.springs));
  MatX G = MatX::Zero(9, 9);
  for (int c = 0; c < 3; ++c) G.block<3, 3>(3 * c, 3 * c) = held.springs[static_cast<std::size_t>(c)];
  const Eigen::PartialPivLU<MatX> lu(MatX::Identity(9, 9) + alone * G);
  EXPECT_LT((compliance - lu.solve(alone)).norm(), 1e-8 * compliance.norm());
  EXPECT_LT((free - lu.solve(free_alone)).norm(), 1e-8 * free_alone.norm());
}

TEST_P(NeedleContract, the_step_on_springs_reaches_the_same_equilibrium_quadratically) {
  // The caller includes the springs' forces in its own equations; in this test they are real springs at the load
  // points.
  const auto needle = make();
  const Held held;
  std::vector<Vec3> anchor;
  for (const PointLoad& load : held.loads) anchor.push_back(needle->point(load.s) + Vec3(0.3, -0.2, 0.0));
  MatX compliance(9, 9);
  VecX free(9);
  double residual = 0.0;
  std::vector<PointLoad> loads = held.loads;
  const auto hang = [&] {
    for (std::size_t c = 0; c < 3; ++c)
      loads[c].force = held.loads[c].force + held.springs[c] * (anchor[c] - needle->point(loads[c].s));
  };
  int iterations = 0;
  for (; iterations < 12; ++iterations) {
    hang();
    residual = needle->residual(loads);
    if (residual < 3.0 * tolerance()) break;
    EXPECT_TRUE(needle->linearise(loads, compliance, free, held.springs));
    needle->advance(loads);
  }
  EXPECT_LT(residual, 3.0 * tolerance());
  EXPECT_LE(iterations, 9);
}

TEST_P(NeedleContract, the_model_is_the_one_named) { EXPECT_EQ(make()->model(), model()); }

STYLET_FOR_EVERY_NEEDLE_MODEL(NeedleContract);

}  // namespace
}  // namespace stylet
