// SPDX-License-Identifier: GPL-3.0-or-later
// A balance is solved from where the sub-step will probably end (src/coupling/expectation.cpp).
#include "needle_in_block.hpp"

#include <random>

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

TEST(Expectation, a_needle_that_goes_on_as_before_takes_two_iterations_a_step) {
  NeedleInBlock run;
  run.aim({1.3, 0.7, 0.0});
  run.go(30.0);
  int iterations = 0;
  int steps = 0;
  while (run.depth < 38.0) {
    run.go(run.depth + 20.0 * test::kStep_s);
    iterations += run.report.iterations;
    ++steps;
  }
  EXPECT_LT(iterations, 2.5 * steps);
  EXPECT_EQ(run.flags, 0u);
}

TEST(Expectation, a_hand_that_goes_on_sideways_is_expected_to) {
  NeedleInBlock run;
  run.aim({1.3, 0.7, 0.0}, {0.2, 0.1, 1.0});
  run.go(30.0);
  const Vec3 aside = 0.02 * run.axis.unitOrthogonal();
  int iterations = 0;
  constexpr int steps = 100;
  for (int k = 0; k < steps; ++k) {
    run.sideways += aside;
    run.step(1e-3);
    iterations += run.report.iterations;
  }
  EXPECT_LT(iterations, 3.5 * steps);
  EXPECT_EQ(run.flags, 0u);
}

TEST(Expectation, what_is_expected_wrongly_does_not_change_the_balance) {
  // The staggered solver starts each sub-step from the forces and the shape that the last one ended with.
  BlockOptions options;
  NeedleInBlock coupled(options);
  options.coupling.solver = CouplingSettings::Solver::staggered;
  NeedleInBlock staggered(options);
  for (NeedleInBlock* run : {&coupled, &staggered}) {
    run->aim({1.3, 0.7, 0.0});
    run->go(25.0, 40.0);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> way(-0.03, 0.06), aside(-0.02, 0.02);
    for (int k = 0; k < 200; ++k) {
      run->depth += way(random);
      run->sideways = {aside(random), aside(random), 0.0};
      run->step(1e-3);
    }
    EXPECT_EQ(run->flags, 0u);
  }
  ASSERT_EQ(coupled.forces.size(), staggered.forces.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < coupled.forces.size(); ++k)
    largest = std::max(largest, std::abs(coupled.forces[k] - staggered.forces[k]));
  EXPECT_LT(largest, 1e-6 * coupled.peak());
  EXPECT_LT((coupled.report.hand_force - staggered.report.hand_force).norm(), 1e-6 * coupled.peak());
  EXPECT_EQ(coupled.happened.size(), staggered.happened.size());
}

}  // namespace
}  // namespace stylet
