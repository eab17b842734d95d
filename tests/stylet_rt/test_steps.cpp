// SPDX-License-Identifier: GPL-3.0-or-later
// Tests simulations of one model that are stepped through the C interface from several threads.
#include "handle.hpp"
#include "sim/box_patient.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A model of the box patient. @param corridor_mm 0 = the scenario's default
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

TEST(SimulationsInC, go_beyond_the_corridor_once_prepared) {
  const ModelHandle model = box(1.0);
  const SimHandle sim = created(model);
  const Index before = model->model->store()->stored_nodes();
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
  EXPECT_GT(sim->simulation.insertion().store().stored_nodes(), before);
  EXPECT_GT(most_N, 0.3);
}

TEST(SimulationsInC, step_while_another_goes_beyond_the_corridor) {
  const ModelHandle model = box(1.0);
  const Index before = model->model->store()->stored_nodes();
  const std::vector<double> expected = forces(created(model).get());
  const SimHandle steps = created(model), prepares = created(model);
  std::vector<double> meanwhile;
  std::thread stepping([&] { meanwhile = forces(steps.get()); });
  for (int k = 1; k <= kSteps; ++k) {
    EXPECT_EQ(stylet_rt_sim_prepare(prepares.get(), nullptr, 0), STYLET_RT_OK);
    stylet_rt_pose base{};
    EXPECT_EQ(stylet_rt_sim_planned_base(prepares.get(), k * kStep_s, &base), STYLET_RT_OK);
    base.position_mm[0] -= 9.0;
    EXPECT_EQ(stylet_rt_sim_step(prepares.get(), &base, kStep_s, nullptr), STYLET_RT_OK);
  }
  stepping.join();
  EXPECT_EQ(meanwhile, expected);
  EXPECT_GT(prepares->simulation.insertion().store().stored_nodes(), before);
  EXPECT_EQ(model->model->store()->stored_nodes(), before);
}

TEST(SimulationsInC, have_a_worker_bring_what_lies_beyond_the_corridor) {
  const ModelHandle model = box(1.0);
  stylet_rt_options options{};
  options.struct_size = sizeof options;
  options.flags = STYLET_RT_WORKER;
  stylet_rt_sim* made = nullptr;
  ASSERT_EQ(stylet_rt_sim_create(model.get(), &options, &made, nullptr, 0), STYLET_RT_OK);
  const SimHandle sim(made);
  stylet_rt_pose base{};
  stylet_rt_result result{};
  for (int k = 1; k <= kSteps; ++k) {
    ASSERT_EQ(stylet_rt_sim_planned_base(sim.get(), k * kStep_s, &base), STYLET_RT_OK);
    base.position_mm[0] -= 9.0;
    if (result.contacts == 0) {  // so that the needle can enter
      ASSERT_EQ(stylet_rt_sim_prepare(sim.get(), nullptr, 0), STYLET_RT_OK);
    }
    ASSERT_EQ(stylet_rt_sim_step(sim.get(), &base, kStep_s, &result), STYLET_RT_OK);
    EXPECT_EQ(result.flags & ~STYLET_RT_COMPLIANCE_MISSING, 0u) << "step " << k;
  }
  int in_a_row = 0;
  for (int k = 0; k < 20000 && in_a_row < 100; ++k) {
    ASSERT_EQ(stylet_rt_sim_step(sim.get(), &base, kStep_s, &result), STYLET_RT_OK);
    in_a_row = result.flags == 0 ? in_a_row + 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(in_a_row, 100);
  EXPECT_GT(result.contacts, 3);
}
