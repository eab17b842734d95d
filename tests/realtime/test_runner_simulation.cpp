// SPDX-License-Identifier: GPL-3.0-or-later
#include "runner_parts.hpp"
#include "sim/base_steps.hpp"
#include "sim/box_patient.hpp"
#include "stylet/realtime/scripted_device.hpp"

#include <algorithm>
#include <cmath>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A model whose insertion takes about one second: in, a short pause, and out.
std::shared_ptr<const Model> one_second() {
  static const std::shared_ptr<const Model> model = [] {
    Scenario s = box_scenario();
    s.insertions[0].depth_mm = 20.0;
    s.insertions[0].speed_mm_per_s = 50.0;
    s.insertions[0].retract_speed_mm_per_s = 50.0;
    return compiled(s);
  }();
  return model;
}

RunnerSettings slow_settings() {
  RunnerSettings s = plain_settings();
  s.period_s = 4e-3;
  s.late_after_s = 0.5;
  return s;
}

/// A runner of the box model with a scripted device, which counts the allocations of both threads.
struct BoxRun {
  CountingBody* body = nullptr;
  CountingDevice* device = nullptr;
  SimulationSteppable* simulation = nullptr;
  std::unique_ptr<RealtimeRunner> runner;

  explicit BoxRun(const RunnerSettings& settings) {
    auto s = SimulationSteppable::create(one_second());
    if (!s) throw std::runtime_error(s.error().message());
    simulation = s->get();
    auto b = std::make_unique<CountingBody>(*std::move(s));
    auto d = std::make_unique<CountingDevice>(std::make_unique<ScriptedDevice>(one_second()->insertions()[0].motion));
    body = b.get();
    device = d.get();
    auto made = RealtimeRunner::create(std::move(b), std::move(d), settings);
    if (!made) throw std::runtime_error(made.error().message());
    runner = std::move(*made);
  }

  /// Runs until the end of the script, and passes each new snapshot to `look`.
  void run(const std::function<void(const Snapshot&)>& look = {}) const {
    const double end = one_second()->insertions()[0].motion.duration_s();
    ASSERT_TRUE(runner->start().ok());
    ASSERT_TRUE(comes_true([&] {
      if (runner->fetch_snapshot() && look) look(runner->snapshot());
      return runner->snapshot().step.time_s > end + 0.02;
    }));
    runner->stop();
  }
};

}  // namespace

TEST(RealtimeRunner, takes_a_simulation_through_an_insertion_led_by_a_script) {
  BoxRun box(slow_settings());
  int seen = 0;
  double last = 0.0;
  double most_N = 0.0;
  box.run([&](const Snapshot& s) {
    ++seen;
    ASSERT_GT(s.step.time_s, last);
    last = s.step.time_s;
    most_N = std::max(most_N, s.step.force_axial_N);
    // All data belong to the same step: the centreline runs from base to tip, and the hand's force balances the
    // contacts.
    ASSERT_EQ(vec3(s.centreline.front()), s.step.base.origin);
    ASSERT_EQ(vec3(s.centreline.back()), s.step.tip_mm);
    Vec3 contacts = Vec3::Zero();
    for (int k = 0; k < s.contact_count; ++k) contacts += vec3(s.contacts[static_cast<std::size_t>(k)].force);
    ASSERT_NEAR((contacts - s.step.hand_force_N).norm(), 0.0, 1e-9);
    ASSERT_EQ(s.contacts_left_out, 0);
    ASSERT_TRUE(s.trusted);
    ASSERT_EQ(s.step.flags & Step::compliance_missing, 0u) << "the plan's corridor is there from the start";
  });
  EXPECT_GT(seen, 10);
  EXPECT_GT(most_N, 0.3);
  EXPECT_EQ(box.runner->snapshot().step.tip_state, TipState::air) << "it came out again";

  std::vector<EventSnapshot> events(100);
  events.resize(box.runner->take_events(events));
  std::vector<EventKind> kinds;
  for (const EventSnapshot& e : events) kinds.push_back(e.kind);
  ASSERT_FALSE(kinds.empty());
  EXPECT_EQ(kinds.front(), EventKind::skin_contact);
  EXPECT_EQ(kinds.back(), EventKind::withdrawn);
  const auto puncture = std::find(kinds.begin(), kinds.end(), EventKind::puncture);
  ASSERT_NE(puncture, kinds.end());
  EXPECT_LT(puncture, std::find(kinds.begin(), kinds.end(), EventKind::retraction_start));
  const auto region = static_cast<std::size_t>(events[static_cast<std::size_t>(puncture - kinds.begin())].region);
  ASSERT_LT(region, one_second()->mesh().regions.size());
  EXPECT_EQ(one_second()->mesh().regions[region], "body");
}

TEST(RealtimeRunner, neither_thread_allocates_from_its_first_turn_to_its_last) {
  if (!AllocationCount::available())
    GTEST_SKIP() << "under a sanitizer the memory functions cannot be replaced by counting ones";
  BoxRun box(slow_settings());
  box.run();
  EXPECT_GT(box.runner->snapshot().counters.steps, 50);
  EXPECT_EQ(box.body->allocations, 0);
  EXPECT_EQ(box.device->allocations, 0);
}

TEST(SimulationSteppable, shows_what_the_simulation_says) {
  const auto made_body = SimulationSteppable::create(one_second());
  ASSERT_TRUE(made_body.ok());
  SimulationSteppable& body = **made_body;
  const BaseMotion& motion = one_second()->insertions()[0].motion;
  Simulation& simulation = body.simulation();
  Snapshot shown;
  int contacts = 0;
  for (double t = 0.0; t < 0.4; t += 4e-3) {
    const StepOutcome outcome = body.step(motion.at(t), 4e-3);
    body.describe(shown);
    EXPECT_EQ(outcome.hand.force, simulation.last_step().hand_force_N);
    EXPECT_EQ(outcome.hand.torque, simulation.last_step().torque_Nmm);
    EXPECT_TRUE(outcome.trusted);
    const std::vector<ContactState> expected = simulation.insertion().contacts();
    ASSERT_EQ(static_cast<std::size_t>(shown.contact_count), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(vec3(shown.contacts[k].position), expected[k].position);
      EXPECT_EQ(vec3(shown.contacts[k].force), expected[k].force);
      EXPECT_EQ(shown.contacts[k].sticking, expected[k].sticking);
      EXPECT_EQ(shown.contacts[k].tip, expected[k].tip);
    }
    contacts = std::max(contacts, shown.contact_count);
    EXPECT_EQ(shown.step.base_depth_mm, simulation.last_step().base_depth_mm);
    EXPECT_EQ(vec3(shown.centreline[32]), simulation.insertion().needle().point(60.0)) << "halfway";
  }
  EXPECT_GT(contacts, 3);
  // With an invalid pose the step is not taken, and its force is not trusted.
  Pose none;
  none.origin.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(body.step(none, 4e-3).trusted);
}

TEST(SimulationSteppable, has_the_tip_error_that_a_report_has_and_keeps_it_while_the_needle_is_drawn_back) {
  const std::shared_ptr<const Model> model = one_second();
  const auto made_body = SimulationSteppable::create(model);
  ASSERT_TRUE(made_body.ok());
  SimulationSteppable& body = **made_body;
  const PlannedInsertion& plan = model->insertions()[0];
  const BaseSteps motion = planned_steps(*model, plan);
  const long deepest = deepest_step(*model, plan, motion);
  std::optional<TipError> at_deepest;
  int grew = 0;
  int kept = 0;
  Snapshot shown;
  for (long k = 1; k <= motion.count; ++k) {
    body.step(motion.base(k), motion.dt_s(k));
    body.describe(shown);
    const Step& step = body.simulation().last_step();
    const auto now = tip_error_mm(body.simulation().insertion(), step);
    ASSERT_EQ(shown.tip_error.has_value(), now.has_value()) << "step " << k << ", " << to_string(step.tip_state);
    if (!now) continue;
    if (k <= deepest) {
      ASSERT_EQ(shown.tip_error->mm, *now) << "step " << k;
      ASSERT_EQ(shown.tip_error->base_depth_mm, step.base_depth_mm);
      at_deepest = shown.tip_error;
      ++grew;
    } else if (step.base_depth_mm < at_deepest->base_depth_mm - 0.1) {
      ASSERT_EQ(shown.tip_error->mm, at_deepest->mm) << "step " << k;
      ++kept;
    }
  }
  EXPECT_GT(grew, 100);
  EXPECT_GT(kept, 50);
  EXPECT_FALSE(shown.tip_error) << "the needle is out";
  const Finished finished(model);
  ASSERT_TRUE(finished.summary.tip_error_mm && at_deepest);
  EXPECT_LT((at_deepest->mm - *finished.summary.tip_error_mm).norm(), 1e-9);
  EXPECT_LT(at_deepest->mm.z(), -0.1) << "the tissue gave way";
}

TEST(SimulationSteppable, begins_with_the_needles_that_stay_and_gives_the_forces_of_a_run_beside_them) {
  Scenario s = box_scenario();
  s.insertions[0].depth_mm = 20.0;
  s.procedure.stabilising = {"C3", "E4"};
  const std::shared_ptr<const Model> model = compiled(s);
  const auto made = SimulationSteppable::create(model);
  ASSERT_TRUE(made.ok());
  SimulationSteppable& body = **made;
  const auto shown = std::make_unique<Snapshot>();
  body.describe(*shown);
  ASSERT_EQ(shown->resting_count, 2);
  for (std::size_t k = 0; k < 2; ++k) {
    const PlannedInsertion& stays = model->staying()[k];
    const Vec3 tip = vec3(shown->resting[k].back());
    EXPECT_LT((tip - stays.entry - stays.depth_mm * stays.direction).norm(), 3.0) << "it has bent a little";
    const Needle& needle = body.simulation().insertion().needle(static_cast<int>(k));
    EXPECT_EQ(tip, needle.point(needle.length()));
  }
  EXPECT_GT(shown->force_count, 6) << "they press the tissue before the needle comes";

  const Finished finished(model);
  Scenario alone = s;
  alone.procedure.stabilising.clear();
  const Finished free(compiled(alone));
  const BaseSteps motion = planned_steps(*model, model->insertions()[0]);
  double beside = 0.0;
  for (long k = 1; k <= motion.count; ++k) {
    body.step(motion.base(k), motion.dt_s(k));
    const auto at = static_cast<std::size_t>(k - 1);
    const double force_N = body.simulation().last_step().force_axial_N;
    ASSERT_NEAR(force_N, finished.kept.steps[at].force_axial_N, 1e-9) << "step " << k;
    beside = std::max(beside, std::abs(force_N - free.kept.steps[at].force_axial_N));
  }
  EXPECT_GT(beside, 0.01) << "they are felt";
}

TEST(ScriptedDevice, follows_simulated_time_and_stamps_with_the_clock) {
  ScriptedDevice device(one_second()->insertions()[0].motion);
  const DeviceInput input = device.read({.now_s = 7.0, .simulated_s = 0.25});
  EXPECT_TRUE(input.valid);
  EXPECT_EQ(input.time_s, 7.0);
  EXPECT_EQ(vec3(input.pose.origin), one_second()->insertions()[0].motion.at(0.25).origin);
}
