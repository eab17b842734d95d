// SPDX-License-Identifier: GPL-3.0-or-later
// Random insertions into the demo patient: needle and tissue must find a balance for every way and speed.
#include "stylet/measure/demo.hpp"
#include "stylet/mesher/mesher.hpp"
#include "stylet/sim/simulation.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stylet {
namespace {

/// Uniform in [from, to); the same on every machine.
double uniform(std::mt19937& random, double from, double to) {
  return from + (to - from) * (static_cast<double>(random()) / 4294967296.0);
}

TEST(DemoInsertions, find_a_balance_in_all_but_a_few_steps) {
  constexpr int ways = 30;
  constexpr double dt_s = 1e-3, above_mm = 8.0;
  auto meshed = test::value_of(measure::mesh_demo(500, {}));
  const auto model = test::value_of(Model::compile(measure::demo_scenario(), std::move(meshed.mesh), "demo"));
  const PlannedInsertion& plan = model->insertions().front();
  const double length = model->scenario().needle.length_mm;
  std::mt19937 random(5);
  long steps = 0, unbalanced = 0;
  for (int k = 0; k < ways; ++k) {
    const Vec3 entry = plan.entry + Vec3(uniform(random, -20.0, 20.0), uniform(random, -20.0, 20.0), 0.0);
    const Vec3 direction =
        (plan.direction + Vec3(uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), 0.0)).normalized();
    const double speed_mm_per_s = 5.0 * std::pow(30.0, uniform(random, 0.0, 1.0));
    const double depth = uniform(random, 50.0, 75.0);
    const auto base_at = [&](double tip_depth) {
      return pose_along(entry + (tip_depth - length) * direction, direction);
    };
    Simulation simulation(model);
    simulation.place(base_at(-above_mm), entry, direction);
    const auto count = std::lround((depth + above_mm) / (speed_mm_per_s * dt_s));
    for (long n = 1; n <= 2 * count; ++n) {
      const double way =
          (depth + above_mm) * static_cast<double>(n <= count ? n : 2 * count - n) / static_cast<double>(count);
      simulation.prepare();
      simulation.step(base_at(way - above_mm), dt_s);
      ++steps;
      unbalanced += (simulation.last_step().flags & Step::not_converged) != 0 ? 1 : 0;
    }
  }
  EXPECT_LT(static_cast<double>(unbalanced), 5e-5 * static_cast<double>(steps))
      << unbalanced << " of " << steps << " steps without a balance";
}

}  // namespace
}  // namespace stylet
