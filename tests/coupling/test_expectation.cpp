// SPDX-License-Identifier: GPL-3.0-or-later
// The prediction: a balance is solved from the probable end of the sub-step (src/coupling/balance/predictor.hpp).
#include "needle_in_block.hpp"

#include <random>

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

TEST(Expectation, a_needle_that_goes_on_as_before_takes_little_more_than_one_iteration_a_step) {
  NeedleInBlock run;
  run.aim({1.3, 0.7, 0.0});
  run.go(33.0);
  ASSERT_EQ(run.count(EventKind::puncture), 2) << "skin and capsule";
  int iterations = 0;
  int steps = 0;
  while (run.depth < 57.0) {  // six more contacts
    run.go(run.depth + 0.02, 20.0, 1e-3);
    iterations += run.report.iterations;
    ++steps;
  }
  EXPECT_LT(iterations, 1.1 * steps);
  EXPECT_EQ(run.flags, 0u);
}

/// Iterations in a hundred steps, in each of which the base moves 0.02 mm sideways.
int iterations_sideways(bool steadily) {
  NeedleInBlock run;
  run.aim({1.3, 0.7, 0.0}, {0.2, 0.1, 1.0});
  run.go(30.0);
  const Vec3 aside = 0.02 * run.axis.unitOrthogonal();
  const Vec3 across = run.axis.normalized().cross(aside);
  int iterations = 0;
  for (int k = 0; k < 100; ++k) {
    run.sideways += steadily || k % 2 == 0 ? aside : across;
    run.step(1e-3);
    iterations += run.report.iterations;
  }
  EXPECT_EQ(run.flags, 0u);
  return iterations;
}

TEST(Expectation, a_hand_that_goes_on_sideways_takes_fewer_iterations_than_one_that_zigzags) {
  EXPECT_LT(iterations_sideways(true), 0.8 * iterations_sideways(false));
}

TEST(Expectation, what_is_expected_wrongly_does_not_change_the_balance) {
  // The staggered solver starts each sub-step from the forces and the shape at the end of the last one.
  BlockOptions options;
  NeedleInBlock coupled(options);
  options.coupling.solver = CouplingSettings::Solver::staggered;
  NeedleInBlock staggered(options);
  for (NeedleInBlock* run : {&coupled, &staggered}) {
    run->aim({1.3, 0.7, 0.0});
    run->go(25.0, 40.0);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> way(-0.03, 0.06), aside(-0.02, 0.02);
    std::uniform_int_distribution<int> how_long(1, 5), halts(0, 4);
    for (int k = 0; k < 60; ++k) {
      const double further = way(random);
      const Vec3 swing(aside(random), aside(random), 0.0);
      for (int steps = how_long(random); steps > 0; --steps) {
        run->depth += further;
        run->sideways += swing;
        run->step(1e-3);
      }
      run->sideways *= 0.5;
      if (halts(random) == 0) run->step(1e-3);
    }
    EXPECT_EQ(run->flags, 0u);
  }
  ASSERT_EQ(coupled.forces.size(), staggered.forces.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < coupled.forces.size(); ++k)
    largest = std::max(largest, std::abs(coupled.forces[k] - staggered.forces[k]));
  EXPECT_LT(largest, 1e-6 * coupled.peak());
  EXPECT_LT((coupled.report.hand_force_N - staggered.report.hand_force_N).norm(), 1e-6 * coupled.peak());
  EXPECT_EQ(coupled.happened.size(), staggered.happened.size());
}

}  // namespace
}  // namespace stylet
