// SPDX-License-Identifier: GPL-3.0-or-later
// Simulations of one model, stepped through the C interface from several threads.
#include "sim/box_patient.hpp"
#include "stylet_rt/handles.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

using namespace stylet;

namespace {

struct Free {
  void operator()(stylet_rt_model* model) const { stylet_rt_model_destroy(model); }
  void operator()(stylet_rt_sim* sim) const { stylet_rt_sim_destroy(sim); }
};
using ModelHandle = std::unique_ptr<stylet_rt_model, Free>;
using SimHandle = std::unique_ptr<stylet_rt_sim, Free>;

/// @param corridor_mm 0 = as it comes
ModelHandle box(double corridor_mm = 0.0) {
  Scenario scenario = test::box_scenario();
  if (corridor_mm > 0.0) scenario.coupling.corridor_mm = corridor_mm;
  return ModelHandle(rt::make_handle(test::compiled(scenario)));
}

SimHandle created(const ModelHandle& model) {
  stylet_rt_sim* sim = nullptr;
  EXPECT_EQ(stylet_rt_sim_create(model.get(), nullptr, &sim, nullptr, 0), STYLET_RT_OK);
  return SimHandle(sim);
}

constexpr double kStep_s = 4e-3;
constexpr int kSteps = 250;

/// Axial forces of the planned insertion.
std::vector<double> forces(stylet_rt_sim* sim) {
  std::vector<double> all;
  for (int k = 1; k <= kSteps; ++k) {
    stylet_rt_pose base{};
    stylet_rt_result result{};
    EXPECT_EQ(stylet_rt_sim_planned_base(sim, k * kStep_s, &base), STYLET_RT_OK);
    EXPECT_EQ(stylet_rt_sim_step(sim, &base, kStep_s, &result), STYLET_RT_OK);
    all.push_back(result.force_axial_N);
  }
  return all;
}

}  // namespace

TEST(SimulationsInC, of_one_model_step_in_two_threads_as_in_one) {
  ModelHandle model = box();
  const std::vector<double> expected = forces(created(model).get());
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.3);
  const SimHandle one = created(model), two = created(model);
  model.reset();
  std::vector<double> of_one, of_two;
  std::thread first([&] { of_one = forces(one.get()); });
  std::thread second([&] { of_two = forces(two.get()); });
  first.join();
  second.join();
  EXPECT_EQ(of_one, expected);
  EXPECT_EQ(of_two, expected);
}

TEST(SimulationsInC, are_told_when_one_of_them_prepares) {
  const ModelHandle model = box();
  const SimHandle sim = created(model);
  stylet_rt_pose base{};
  stylet_rt_result result{};
  std::size_t count = 0;
  stylet_rt_sim* another = nullptr;
  ASSERT_EQ(stylet_rt_sim_planned_base(sim.get(), kStep_s, &base), STYLET_RT_OK);
  {
    const rt::Changing prepares(model->shared->gate);
    ASSERT_TRUE(prepares);
    EXPECT_EQ(stylet_rt_sim_step(sim.get(), &base, kStep_s, &result), STYLET_RT_BUSY);
    EXPECT_EQ(stylet_rt_sim_place(sim.get(), 0), STYLET_RT_BUSY);
    EXPECT_EQ(stylet_rt_sim_prepare(sim.get(), nullptr, 0), STYLET_RT_BUSY);
    EXPECT_EQ(stylet_rt_sim_read_contacts(sim.get(), nullptr, 0, &count), STYLET_RT_BUSY);
    EXPECT_EQ(stylet_rt_sim_create(model.get(), nullptr, &another, nullptr, 0), STYLET_RT_BUSY);
    EXPECT_EQ(stylet_rt_sim_read_result(sim.get(), &result), STYLET_RT_OK);
    EXPECT_EQ(result.time_s, 0.0) << "no step was taken";
  }
  EXPECT_EQ(stylet_rt_sim_step(sim.get(), &base, kStep_s, &result), STYLET_RT_OK);
  {
    const rt::Reading steps(model->shared->gate);
    EXPECT_EQ(stylet_rt_sim_prepare(sim.get(), nullptr, 0), STYLET_RT_BUSY);
    EXPECT_EQ(stylet_rt_sim_step(sim.get(), &base, kStep_s, &result), STYLET_RT_OK);
  }
  EXPECT_EQ(stylet_rt_sim_prepare(sim.get(), nullptr, 0), STYLET_RT_OK);
}

TEST(SimulationsInC, go_beyond_the_corridor_once_prepared) {
  const ModelHandle model = box(1.0);
  const SimHandle sim = created(model);
  const auto stored = [&] { return model->shared->model->store()->stored_nodes(); };
  const Index before = stored();
  stylet_rt_result result{};
  double most_N = 0.0;
  for (int k = 1; k <= kSteps; ++k) {
    stylet_rt_pose base{};
    ASSERT_EQ(stylet_rt_sim_planned_base(sim.get(), k * kStep_s, &base), STYLET_RT_OK);
    base.position_mm[0] -= 9.0;
    if (k == 1) {
      ASSERT_EQ(stylet_rt_sim_step(sim.get(), &base, kStep_s, &result), STYLET_RT_OK);
    }
    ASSERT_EQ(stylet_rt_sim_prepare(sim.get(), nullptr, 0), STYLET_RT_OK);
    ASSERT_EQ(stylet_rt_sim_step(sim.get(), &base, kStep_s, &result), STYLET_RT_OK);
    EXPECT_EQ(result.flags & STYLET_RT_COMPLIANCE_MISSING, 0u) << "step " << k;
    most_N = std::max(most_N, result.force_axial_N);
  }
  EXPECT_GT(stored(), before);
  EXPECT_GT(most_N, 0.3);
}

TEST(SimulationsInC, step_while_another_prepares_or_are_told) {
  const ModelHandle model = box(1.0);
  const SimHandle steps = created(model), prepares = created(model);
  const auto stored = [&] { return model->shared->model->store()->stored_nodes(); };
  const Index before = stored();
  std::thread stepping([&] {
    for (int taken = 0; taken < kSteps;) {
      stylet_rt_pose base{};
      stylet_rt_result result{};
      stylet_rt_sim_planned_base(steps.get(), (taken + 1) * kStep_s, &base);
      const stylet_rt_status status = stylet_rt_sim_step(steps.get(), &base, kStep_s, &result);
      if (status == STYLET_RT_OK) {
        ++taken;
        EXPECT_TRUE(std::isfinite(result.force_axial_N));
      } else {
        EXPECT_EQ(status, STYLET_RT_BUSY);
      }
      std::this_thread::yield();
    }
  });
  for (int prepared = 0; prepared < kSteps;) {
    const stylet_rt_status status = stylet_rt_sim_prepare(prepares.get(), nullptr, 0);
    if (status == STYLET_RT_OK) {
      ++prepared;
      stylet_rt_pose base{};
      stylet_rt_sim_planned_base(prepares.get(), prepared * kStep_s, &base);
      base.position_mm[0] -= 9.0;
      EXPECT_EQ(stylet_rt_sim_step(prepares.get(), &base, kStep_s, nullptr), STYLET_RT_OK);
    } else {
      EXPECT_EQ(status, STYLET_RT_BUSY);
      std::this_thread::yield();
    }
  }
  stepping.join();
  EXPECT_GT(stored(), before);
}
