// SPDX-License-Identifier: GPL-3.0-or-later
// Internal damping (Kelvin–Voigt) in implicit Euler steps of τ / ratio. Rods get a moment EI (κ + τ dκ/dt), tetrahedra
// a stress C (E + τ dE/dt).
#include "stylet/needle/springs.hpp"
#include "stylet/needle/tet.hpp"
#include "stylet/needle/theory.hpp"
#include "support.hpp"

#include <cmath>
#include <numbers>

namespace stylet {
namespace {

using test::kEI;
using test::kLength;

/// Newton's iteration. find_equilibrium() cannot be used, because it minimises the potential energy without damping.
int balance(Needle& needle, const std::vector<PointLoad>& loads, double tolerance_Nmm) {
  int iterations = 0;
  for (; needle.residual(loads) > tolerance_Nmm && iterations < 30; ++iterations) {
    test::compliance_of(needle, loads);
    needle.advance(loads);
  }
  return iterations;
}

std::vector<std::unique_ptr<Needle>> needles() {
  std::vector<std::unique_ptr<Needle>> result;
  result.push_back(test::beam());
  result.push_back(SpringsNeedle::build({}, 24, 8).value());
  result.push_back(TetNeedle::build({}, 24, 8).value());
  return result;
}

TEST(NeedleDamping, lets_a_small_deflection_grow_exponentially_to_that_at_rest) {
  // (1 + ratio) w_k − ratio w_{k−1} = w, so w_k = w (1 − (ratio / (1 + ratio))^k).
  const std::vector<PointLoad> loads = {{kLength, {1e-5, 0, 0}}};
  for (const auto& needle : needles()) {
    balance(*needle, loads, 1e-12);
    const double at_rest = needle->point(kLength).x();
    needle->straighten();
    constexpr double ratio = 3.0;
    for (int k = 1; k <= 40; ++k) {
      needle->damp(ratio);
      balance(*needle, loads, 1e-12);
      const double expected = at_rest * (1.0 - std::pow(ratio / (1.0 + ratio), k));
      ASSERT_NEAR(needle->point(kLength).x(), expected, 1e-6 * at_rest) << needle->model() << ", step " << k;
    }
    needle->damp(0.0);
    balance(*needle, loads, 1e-12);
    EXPECT_NEAR(needle->point(kLength).x(), at_rest, 1e-9 * at_rest) << needle->model();
  }
}

TEST(NeedleDamping, makes_the_tangent_definite_and_exact_beyond_the_buckling_load) {
  const double critical = std::numbers::pi * std::numbers::pi * kEI / (4.0 * kLength * kLength);
  const std::vector<PointLoad> loads = {{kLength, {1e-3, 0, -3.0 * critical}}};
  for (const auto& needle : needles()) {
    MatX compliance(3, 3);
    VecX free(3);
    // Tetrahedra buckle under stress, which therefore has to exist first.
    balance(*needle, {{kLength, {0, 0, -3.0 * critical}}}, 1e-2);
    EXPECT_FALSE(needle->linearise(loads, compliance, free, {}, Indefinite::give_up)) << needle->model();
    needle->straighten();
    needle->damp(4.0);
    EXPECT_TRUE(needle->linearise(loads, compliance, free, {}, Indefinite::give_up)) << needle->model();
    // The compliance predicts the next equilibrium for another load exactly: Newton's step is exact.
    balance(*needle, loads, 1e-10);
    compliance = test::compliance_of(*needle, loads);
    const Vec3 before = needle->point(kLength);
    constexpr double more_N = 1e-5;
    std::vector<PointLoad> changed = loads;
    changed.front().force.y() += more_N;
    balance(*needle, changed, 1e-10);
    EXPECT_NEAR((needle->point(kLength) - before).y(), compliance(1, 1) * more_N, 1e-6 * compliance(1, 1) * more_N)
        << needle->model();
    EXPECT_LE(balance(*needle, loads, 1e-10), 4) << needle->model();
  }
}

TEST(NeedleDamping, an_old_tangent_finds_the_same_shape) {
  const std::vector<PointLoad> loads = {{0.6 * kLength, {0.05, 0.02, 0}}, {kLength, {0, -0.03, 0}}};
  const auto others = needles();
  for (const auto& needle : needles()) {
    SCOPED_TRACE(needle->model());
    const auto other = std::find_if(others.begin(), others.end(),
                                    [&](const auto& candidate) { return candidate->model() == needle->model(); });
    needle->damp(2.0);
    (*other)->damp(2.0);
    balance(*needle, loads, 1e-10);
    if (needle->model() == "tet") {  // must start near the solution, because tetrahedra stretch when they turn
      const std::vector<PointLoad> nearly = {{loads[0].s, 0.98 * loads[0].force}, {loads[1].s, 0.98 * loads[1].force}};
      balance(**other, nearly, 1e-10);
    }
    test::compliance_of(**other, loads);
    (*other)->advance(loads);
    VecX free(6);
    for (int k = 0; k < 30; ++k) {
      ASSERT_TRUE((*other)->relax(loads, free));
      (*other)->advance(loads);
    }
    EXPECT_LT((*other)->residual(loads), 1e-9);
    EXPECT_LT(((*other)->state() - needle->state()).norm(), 1e-9 * needle->state().norm());
  }
}

}  // namespace
}  // namespace stylet
