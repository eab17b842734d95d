// SPDX-License-Identifier: GPL-3.0-or-later
// Random insertions into the demo patient: needle and tissue must find a balance for every way and speed.
#include "stylet/measure/demo.hpp"
#include "stylet/mesher/mesher.hpp"
#include "stylet/phantom/phantom.hpp"
#include "stylet/sim/simulation.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

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

/// Through hole d5 the tip presses on an oblique part of the capsule with 6 N, and the tissue before it is squeezed
/// beyond the linear model.
TEST(OddPaths, break_no_surface_again_and_again) {
  Scenario scenario = measure::demo_scenario();
  scenario.insertions[0].hole = "d5";
  const MeshedAnatomy meshed = test::value_of(measure::mesh_demo(scenario.mesh.nodes, {}));
  const auto model = test::value_of(Model::compile(scenario, meshed.mesh, "the demo"));
  const PlannedInsertion& plan = model->insertions().front();
  for (const double dt_s : {1e-3, 2e-3, 4e-3}) {
    SCOPED_TRACE(std::to_string(1e3 * dt_s) + " ms");
    Simulation simulation(model);
    simulation.place(plan);
    int punctures = 0;
    double most_N = 0.0;
    for (long k = 1; k <= std::lround(plan.motion.duration_s() / dt_s); ++k) {
      simulation.prepare();
      const Step& step = simulation.step(plan.motion.at(static_cast<double>(k) * dt_s), dt_s);
      most_N = std::max(most_N, step.hand_force_N.norm());
      for (const Event& event : simulation.new_events()) punctures += event.kind == EventKind::puncture ? 1 : 0;
    }
    EXPECT_EQ(punctures, 2) << "skin and capsule";
    EXPECT_LT(most_N, 8.0);
  }
}

/// A needle through the gland's base into the bladder, and a thin one that buckles on the skin: paths on which the
/// balance once fell.
TEST(OddPaths, have_a_balance_in_every_step_with_any_time_step_and_the_same_events) {
  const Scenario demo = measure::demo_scenario();
  MeshOptions options;
  options.nodes = 3000;
  options.cull_tolerance_mm = demo.mesh.cull_mm;
  options.layers = demo.anatomy;
  const MeshedAnatomy meshed = test::value_of(mesh_contours(demo_patient({.seed = 11}), options, {}));
  struct Path {
    double diameter_mm, lumen_mm;
    std::array<double, 3> entry_mm;
    double depth_mm, most_N;
    bool breaks;
  };
  const double euler_N = 0.35;  // 2.05 π² E I / L² of the thin needle between hand and hole
  for (const Path& path :
       {Path{1.27, 1.0, {12, 0, -85}, 104.0, 9.0, true}, Path{0.51, 0.26, {8, 2, -85}, 70.0, 2.0 * euler_N, false}}) {
    Scenario scenario = demo;
    scenario.needle.diameter_mm = path.diameter_mm;
    scenario.needle.lumen_diameter_mm = path.lumen_mm;
    scenario.insertions[0].hole.reset();
    scenario.insertions[0].entry_mm = path.entry_mm;
    scenario.insertions[0].depth_mm = path.depth_mm;
    const auto model = test::value_of(Model::compile(scenario, meshed.mesh, "seed 11"));
    const PlannedInsertion& plan = model->insertions().front();
    std::vector<std::pair<EventKind, double>> first;
    for (const double dt_s : {5e-4, 1e-3, 2e-3}) {
      SCOPED_TRACE(std::to_string(path.diameter_mm) + " mm, " + std::to_string(1e3 * dt_s) + " ms");
      Simulation simulation(model);
      simulation.place(plan);
      std::vector<std::pair<EventKind, double>> events;
      double most_N = 0.0, work_Nmm = 0.0, put_in_Nmm = 0.0;
      Vec3 force = Vec3::Zero();
      Pose before = plan.motion.at(0.0);
      for (long k = 1; k <= std::lround(plan.motion.duration_s() / dt_s); ++k) {
        const Pose base = plan.motion.at(static_cast<double>(k) * dt_s);
        simulation.prepare();
        const Step& step = simulation.step(base, dt_s);
        ASSERT_EQ(step.flags, 0u) << step.base_depth_mm << " mm";
        most_N = std::max(most_N, step.hand_force_N.norm());
        const double work = 0.5 * (force + step.hand_force_N).dot(base.origin - before.origin);
        work_Nmm += work;
        put_in_Nmm += std::abs(work);
        force = step.hand_force_N;
        before = base;
        for (const Event& event : simulation.new_events()) events.emplace_back(event.kind, step.base_depth_mm);
      }
      EXPECT_LT(most_N, path.most_N);
      EXPECT_GT(work_Nmm, -1e-3 * put_in_Nmm);
      const bool broke = std::any_of(events.begin(), events.end(),
                                     [](const auto& event) { return event.first == EventKind::puncture; });
      EXPECT_EQ(broke, path.breaks);
      if (first.empty()) first = events;
      ASSERT_EQ(events.size(), first.size());
      for (std::size_t k = 0; k < events.size(); ++k) {
        EXPECT_EQ(events[k].first, first[k].first);
        EXPECT_NEAR(events[k].second, first[k].second, 0.5);
      }
    }
  }
}

}  // namespace
}  // namespace stylet
