// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of compliance that another thread computes while the needle moves.
#include "sim/box_patient.hpp"
#include "stylet/realtime/compliance_worker.hpp"
#include "stylet/realtime/steppable.hpp"

#include <thread>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A model with a narrow corridor, far from the path along which the tests move the needle.
std::shared_ptr<const Model> narrow() {
  static const std::shared_ptr<const Model> model = [] {
    Scenario s = box_scenario();
    s.coupling.corridor_mm = 2.0;
    s.coupling.spare_nodes = 100;
    return compiled(s);
  }();
  return model;
}

/// Pose of the base at a depth of the planned insertion, moved sideways.
Pose beside(double depth_mm) {
  const PlannedInsertion& plan = narrow()->insertions()[0];
  Pose pose = plan.motion.at(0.0);
  const Vec3 tip = pose.origin + narrow()->scenario().needle.length_mm * plan.direction;
  pose.origin += (depth_mm - (tip - plan.entry).dot(plan.direction)) * plan.direction + Vec3(-14.0, 6.0, 0.0);
  return pose;
}

void place_beside(Simulation& simulation) {
  const PlannedInsertion& plan = narrow()->insertions()[0];
  simulation.place(beside(-1.0), plan.entry, plan.direction);
}

constexpr int kSteps = 150;
constexpr double kStep_mm = 0.2;
constexpr double kStep_s = 4e-3;

}  // namespace

TEST(ComplianceWorker, brings_what_prepare_would_have) {
  Simulation alone(narrow());
  place_beside(alone);
  Simulation helped(narrow());
  place_beside(helped);
  const ComplianceWorker worker(helped.supply(), helped.supply_settings());
  for (int k = 0; k < kSteps; ++k) {
    const Pose base = beside(-1.0 + k * kStep_mm);
    alone.prepare();
    alone.step(base, kStep_s);
    helped.prepare();  // waits for the worker
    helped.step(base, kStep_s);
    ASSERT_EQ(helped.last_step().flags, 0u) << k;
    ASSERT_NEAR(helped.last_step().force_axial_N, alone.last_step().force_axial_N, 1e-7) << k;
  }
  EXPECT_GT(alone.last_step().force_axial_N, 0.2);
}

TEST(ComplianceWorker, steps_beside_it_are_sound_or_flagged_and_it_catches_up) {
  const auto made_body = SimulationSteppable::create(narrow());
  ASSERT_TRUE(made_body.ok());
  SimulationSteppable& body = **made_body;
  place_beside(body.simulation());
  for (int k = 0; k < kSteps; ++k) {
    if (k < kSteps / 3) body.simulation().prepare();              // waits for the worker, so that the needle can enter
    std::this_thread::sleep_for(std::chrono::microseconds(200));  // time for some of the compliance, but not for all
    const StepOutcome outcome = body.step(beside(-1.0 + k * kStep_mm), kStep_s);
    ASSERT_TRUE(outcome.hand.finite());
    const unsigned flags = body.simulation().last_step().flags;
    ASSERT_EQ(flags & ~static_cast<unsigned>(Step::compliance_missing), 0u);
  }
  const Pose last = beside(-1.0 + kSteps * kStep_mm);
  int in_a_row = 0;
  for (int k = 0; k < 20000 && in_a_row < 100; ++k) {
    body.step(last, kStep_s);
    in_a_row = body.simulation().last_step().flags == 0 ? in_a_row + 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(in_a_row, 100);
  EXPECT_GT(body.simulation().last_step().contacts, 4);
  const ComplianceStore& store = body.simulation().insertion().store();
  EXPECT_LE(store.stored_nodes(), narrow()->store()->stored_nodes() + narrow()->scenario().coupling.spare_nodes);
}

TEST(ComplianceWorker, simulations_of_one_model_grow_apart_from_each_other) {
  const Index before = narrow()->store()->stored_nodes();
  const auto made_one = SimulationSteppable::create(narrow());
  ASSERT_TRUE(made_one.ok());
  SimulationSteppable& one = **made_one;
  const auto made_other = SimulationSteppable::create(narrow());
  ASSERT_TRUE(made_other.ok());
  SimulationSteppable& other = **made_other;
  place_beside(one.simulation());
  std::thread thread([&] {
    for (int k = 0; k < kSteps; ++k) one.step(beside(-1.0 + k * kStep_mm), kStep_s);
  });
  const PlannedInsertion& plan = narrow()->insertions()[0];
  for (int k = 0; k < kSteps; ++k) other.step(plan.motion.at(k * kStep_s), kStep_s);
  thread.join();
  one.simulation().prepare();
  EXPECT_GT(one.simulation().insertion().store().stored_nodes(), before);
  EXPECT_EQ(narrow()->store()->stored_nodes(), before);
}

TEST(ComplianceWorker, may_stop_whatever_is_under_way_and_another_may_go_on) {
  Simulation simulation(narrow());
  place_beside(simulation);
  for (int k = 0; k < kSteps; ++k) {
    const Pose base = beside(-1.0 + k * kStep_mm);
    if (simulation.last_step().contacts == 0) simulation.prepare();  // so that the needle can enter
    const ComplianceWorker worker(simulation.supply(), simulation.supply_settings());
    simulation.step(base, kStep_s);
    simulation.step(base, kStep_s);
  }
  simulation.prepare();  // on this thread
  const Pose last = beside(-1.0 + kSteps * kStep_mm);
  for (int k = 0; k < 200; ++k) {
    simulation.prepare();
    simulation.step(last, kStep_s);
  }
  EXPECT_EQ(simulation.last_step().flags, 0u);
  EXPECT_GT(simulation.last_step().contacts, 4);
}
