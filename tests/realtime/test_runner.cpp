// SPDX-License-Identifier: GPL-3.0-or-later
#include "runner_parts.hpp"

#include <cmath>

using namespace stylet;
using namespace stylet::test;

namespace {

/// Number of steps according to the newest snapshot.
std::int64_t steps(const SpringRun& run) {
  run.runner->fetch_snapshot();
  return run.runner->snapshot().counters.steps;
}

bool goes_on(const SpringRun& run, int count = 20) {
  const std::int64_t before = steps(run);
  return comes_true([&] { return steps(run) >= before + count; });
}

bool turns(const SpringRun& run, int count) {
  const std::int64_t before = run.hand->turns;
  return comes_true([&] { return run.hand->turns >= before + count; });
}

/// Presses 4 mm into the spring, and waits until the hand feels the full force.
bool pressed(const SpringRun& run) {
  run.hand->z = 4.0;
  return comes_true([&] { return std::abs(run.felt() + 4.0) < 1e-9; });
}

bool nothing_felt(const SpringRun& run) {
  return comes_true([&] { return run.felt() == 0.0; });
}

}  // namespace

TEST(RealtimeRunner, the_base_follows_the_hand_and_the_hand_feels_what_holds_the_base) {
  SpringRun run;
  run.start();
  EXPECT_TRUE(pressed(run));
  run.runner->fetch_snapshot();
  EXPECT_EQ(run.runner->snapshot().step.base.origin[2], 4.0);
  EXPECT_EQ(run.runner->snapshot().step.hand_force_N[2], 4.0);
  EXPECT_TRUE(run.runner->snapshot().trusted);
  run.runner->stop();
  run.expect_gentle();
}

TEST(RealtimeRunner, a_step_stands_for_whole_periods_and_for_no_more_than_the_limit) {
  RunnerSettings s = plain_settings();
  s.max_catch_up = 3;
  SpringRun run(s);
  run.start();
  EXPECT_TRUE(goes_on(run, 100));
  run.body->hang = true;
  EXPECT_TRUE(comes_true([&] { return run.body->hanging.load(); }));
  EXPECT_TRUE(turns(run, 20));
  run.body->hang = false;
  EXPECT_TRUE(goes_on(run, 100));
  run.runner->stop();
  double sum = 0.0;
  for (const double dt : run.body->dts) {
    ASSERT_TRUE(std::abs(dt - 1e-3) < 1e-12 || std::abs(dt - 2e-3) < 1e-12 || std::abs(dt - 3e-3) < 1e-12) << dt;
    sum += dt;
  }
  run.runner->fetch_snapshot();
  const LoopCounters& counters = run.runner->snapshot().counters;
  EXPECT_NEAR(run.runner->snapshot().step.time_s, sum, 1e-9);
  EXPECT_GE(counters.missed_deadlines, 1);
  EXPECT_GE(counters.skipped_periods, 15);
  EXPECT_GE(counters.lost_ns, 15'000'000) << "the stall beyond the limit is no simulated time";
}

TEST(RealtimeRunner, a_step_that_hangs_cannot_keep_a_force_at_the_hand) {
  RunnerSettings s = plain_settings();
  s.late_after_s = 5e-3;
  SpringRun run(s);
  run.start();
  run.hand->z = 4.0;
  EXPECT_TRUE(comes_true([&] { return run.felt() < -1.0; }));
  run.body->hang = true;
  EXPECT_TRUE(comes_true([&] { return run.body->hanging.load(); }));
  EXPECT_TRUE(nothing_felt(run));
  EXPECT_TRUE(run.body->hanging.load()) << "while it still hung";
  run.body->hang = false;
  EXPECT_TRUE(comes_true([&] { return run.felt() < -1.0; })) << "and the force comes back";
  run.runner->stop();
  EXPECT_GE(run.runner->device_snapshot().guard.fades, 1);
  run.expect_gentle();
}

TEST(RealtimeRunner, forces_that_are_no_numbers_or_not_to_be_trusted_fade) {
  for (const bool nonsense : {true, false}) {
    SpringRun run;
    run.start();
    ASSERT_TRUE(pressed(run));
    (nonsense ? run.body->nonsense : run.body->distrust) = true;
    EXPECT_TRUE(nothing_felt(run));
    run.runner->fetch_snapshot();
    EXPECT_FALSE(run.runner->snapshot().trusted);
    EXPECT_GT(run.runner->snapshot().counters.distrusted, 0);
    (nonsense ? run.body->nonsense : run.body->distrust) = false;
    EXPECT_TRUE(pressed(run));
    run.runner->stop();
    run.expect_gentle();
  }
}

TEST(RealtimeRunner, a_handle_lost_from_sight_leaves_the_base_where_it_is_and_feels_nothing) {
  enum class Loss { invalid, old, no_number };
  for (const Loss loss : {Loss::invalid, Loss::old, Loss::no_number}) {
    for (const bool coupled : {false, true}) {
      RunnerSettings s = plain_settings();
      if (coupled) s.coupling = VirtualCouplingSettings{};
      SpringRun run(s);
      // The spring of 1 N/mm is in series with the coupling's 0.5 N/mm.
      const double share = coupled ? 1.0 / 3.0 : 1.0;
      const auto felt = [&](double z) { return comes_true([&] { return std::abs(run.felt() + share * z) < 1e-6; }); };
      run.start();
      run.hand->z = 4.0;
      ASSERT_TRUE(felt(4.0));
      const auto lose = [&](bool lost) {
        if (loss == Loss::invalid) run.hand->valid = !lost;
        if (loss == Loss::old) run.hand->stuck = lost;
        if (loss == Loss::no_number) run.hand->broken = lost;
      };
      lose(true);
      EXPECT_TRUE(nothing_felt(run));
      run.hand->z = 7.0;
      ASSERT_TRUE(goes_on(run));
      EXPECT_NEAR(run.runner->snapshot().step.base.origin[2], 4.0 * share, 1e-6);
      EXPECT_GT(run.runner->snapshot().counters.without_input, 0);
      lose(false);
      EXPECT_TRUE(felt(7.0));
      run.runner->stop();
      run.expect_gentle();
    }
  }
}

TEST(RealtimeRunner, in_pause_nothing_moves_the_force_fades_and_the_device_goes_on) {
  SpringRun run;
  run.start();
  ASSERT_TRUE(pressed(run));
  run.runner->pause();
  ASSERT_TRUE(comes_true([&] {
    run.runner->fetch_snapshot();
    return run.runner->snapshot().paused;
  }));
  const std::int64_t before = run.body->steps;
  const double time = run.runner->snapshot().step.time_s;
  EXPECT_TRUE(nothing_felt(run));
  EXPECT_TRUE(turns(run, 50));
  EXPECT_EQ(run.body->steps, before);
  run.runner->resume();
  EXPECT_TRUE(comes_true([&] { return std::abs(run.felt() + 4.0) < 1e-9; }));
  run.runner->stop();
  run.expect_gentle();
  // The time of the pause does not count as simulated time.
  EXPECT_GT(run.runner->snapshot().step.time_s, time - 1e-12);
}

TEST(RealtimeRunner, takes_exactly_the_single_steps_asked_for) {
  SpringRun run;
  run.runner->pause();
  run.start();
  ASSERT_TRUE(turns(run, 20));
  EXPECT_EQ(run.body->steps, 0);
  run.runner->single_step(3);
  ASSERT_TRUE(comes_true([&] { return steps(run) == 3; }));
  ASSERT_TRUE(turns(run, 20));
  EXPECT_EQ(steps(run), 3);
  EXPECT_NEAR(run.runner->snapshot().step.time_s, 3e-3, 1e-12) << "of one period each, however long it waited";
  EXPECT_TRUE(run.runner->snapshot().paused);
  run.runner->stop();
  EXPECT_EQ(run.body->steps, 3);
}

TEST(RealtimeRunner, stopping_fades_the_force_before_the_device_is_left_alone) {
  SpringRun run;
  run.start();
  ASSERT_TRUE(pressed(run));
  const std::size_t before = static_cast<std::size_t>(run.hand->turns.load());
  run.runner->stop();
  EXPECT_FALSE(run.runner->running());
  run.expect_gentle();
  EXPECT_GT(run.hand->felt.size(), before + 5) << "several turns, not one";
}

TEST(RealtimeRunner, starts_again_where_it_was_and_not_twice_at_a_time) {
  SpringRun run;
  for (int k = 0; k < 3; ++k) {
    run.start();
    EXPECT_TRUE(run.runner->running());
    EXPECT_FALSE(run.runner->start().ok());
    EXPECT_TRUE(pressed(run)) << k;
    run.runner->stop();
    EXPECT_EQ(run.body->at.origin.z(), 4.0);
  }
  run.expect_gentle();
  run.runner->stop();  // a second call has no effect
}

TEST(RealtimeRunner, through_the_coupling_the_hand_feels_the_coupling_however_stiff_the_body) {
  RunnerSettings s = plain_settings();
  s.coupling = VirtualCouplingSettings{};
  SpringRun run(s, [](SpringBody& body) { body.stiffness = 1000.0; });
  run.start();
  run.hand->z = 4.0;
  const double balance = -4.0 * 0.5 * 1000.0 / 1000.5;
  EXPECT_TRUE(comes_true([&] { return std::abs(run.felt() - balance) < 1e-6; })) << run.felt();
  run.runner->fetch_snapshot();
  EXPECT_NEAR(run.runner->snapshot().step.base.origin[2], 4.0 * 0.5 / 1000.5, 1e-6);
  run.runner->stop();
  run.expect_gentle();
}

TEST(RealtimeRunner, a_body_that_gives_more_than_it_took_is_damped) {
  RunnerSettings s = plain_settings();
  s.coupling = VirtualCouplingSettings{};
  SpringRun run(s, [](SpringBody& body) {
    body.stiffness = 0.0;
    body.drive = 1e-3;
  });
  run.start();
  run.hand->sways = true;
  EXPECT_TRUE(comes_true([&] {
    run.runner->fetch_device();
    return run.runner->device_snapshot().damped > 20;
  }));
  EXPECT_LT(run.runner->device_snapshot().lowest_energy_Nmm, 0.0);
  run.runner->stop();
  run.expect_gentle();
}

TEST(RealtimeRunner, events_come_out_in_order_and_those_without_room_are_counted) {
  SpringRun run(plain_settings(), [](SpringBody& body) { body.events_per_step = 32; });
  run.start();
  ASSERT_TRUE(comes_true([&] {
    run.runner->fetch_snapshot();
    return run.runner->snapshot().counters.dropped_events > 100;
  }));
  run.runner->stop();
  run.runner->fetch_snapshot();
  std::vector<EventSnapshot> events(2000);
  events.resize(run.runner->take_events(events));
  EXPECT_GE(events.size(), 1000u);
  for (std::size_t k = 0; k < events.size(); ++k) {
    ASSERT_EQ(events[k].depth_mm, static_cast<double>(k / 32 + 1)) << "the first are kept";
    ASSERT_EQ(events[k].force_N, static_cast<double>(k % 32));
  }
  EXPECT_EQ(static_cast<std::int64_t>(events.size()) + run.runner->snapshot().counters.dropped_events,
            32 * run.body->steps);
}

TEST(RealtimeRunner, times_every_step_and_every_turn) {
  SpringRun run;
  run.start();
  ASSERT_TRUE(goes_on(run, 50));
  EXPECT_GE(run.runner->times()->step_cpu.count(), 50) << "while it runs, too";
  run.runner->stop();
  const auto times = run.runner->times();
  EXPECT_EQ(times->step_cpu.count(), run.body->steps);
  EXPECT_EQ(times->step_wall.count(), run.body->steps);
  EXPECT_GE(times->step_lateness.count(), run.body->steps);
  EXPECT_GE(times->device_wall.count(), run.body->steps / 4);
  EXPECT_EQ(times->device_wall.count(), times->device_lateness.count());
  EXPECT_GT(times->step_wall.largest_ns(), 0);
  EXPECT_EQ(times->step_wall.deadline_ns(), 1'000'000);
}

TEST(RealtimeRunner, takes_what_rights_it_is_given_says_so_and_runs_without) {
  RunnerSettings s = plain_settings();
  s.realtime_scheduling = true;
  s.lock_memory = true;
  s.priority = 5;
  SpringRun run(s);
  run.start();
  ASSERT_TRUE(goes_on(run));
  const ThreadRights rights = run.runner->rights();
  EXPECT_EQ(run.body->policy == SCHED_FIFO, rights.realtime_scheduling) << rights.describe();
  EXPECT_NE(rights.realtime_scheduling, rights.scheduling_error != 0);
  EXPECT_NE(rights.memory_locked, rights.memory_error != 0);
  EXPECT_EQ(rights.priority, rights.realtime_scheduling ? 5 : 0);
  EXPECT_EQ(run.body->flushes.load(), rights.denormals_flushed);
  EXPECT_NE(rights.describe().find(rights.realtime_scheduling ? "real-time scheduling with priority 5" : "ordinary"),
            std::string::npos)
      << rights.describe();
  run.runner->stop();
  volatile double small = std::numeric_limits<double>::min();
  EXPECT_GT(small * 0.25, 0.0) << "only in its own threads";
}

TEST(RealtimeRunner, any_thread_may_command_and_look_on_while_it_runs) {
  SpringRun run;
  run.start();
  std::atomic<bool> done{false};
  std::vector<std::thread> others;
  for (int k = 0; k < 3; ++k) {
    others.emplace_back([&run, &done, k] {
      while (!done) {
        run.runner->pause();
        if (k == 0) run.runner->single_step(2);
        if (k == 1) run.hand->z = 0.01 * static_cast<double>(run.runner->times()->step_cpu.count() % 100);
        run.runner->resume();
        std::this_thread::yield();
      }
    });
  }
  EXPECT_TRUE(goes_on(run, 200));
  done = true;
  for (std::thread& other : others) other.join();
  run.runner->resume();
  EXPECT_TRUE(pressed(run));
  run.runner->stop();
  run.expect_gentle();
}

TEST(RealtimeRunner, refuses_settings_it_cannot_keep_with_value_and_cure) {
  const auto refused = [](const std::function<void(RunnerSettings&)>& change) {
    RunnerSettings s = plain_settings();
    change(s);
    const auto made = RealtimeRunner::create(std::make_unique<SpringBody>(), std::make_unique<TestHand>(), s);
    if (made) return std::string("not refused");
    EXPECT_FALSE(made.error().cure.empty());
    return made.error().message();
  };
  const auto says = [&](const std::string& part, const std::function<void(RunnerSettings&)>& change) {
    const std::string text = refused(change);
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  says("period_s", [](RunnerSettings& s) { s.period_s = 0.0; });
  says("period_s", [](RunnerSettings& s) { s.period_s = std::numeric_limits<double>::quiet_NaN(); });
  says("max_catch_up", [](RunnerSettings& s) { s.max_catch_up = 0; });
  says("late_after_s: 0.001 s is outside 0.002", [](RunnerSettings& s) { s.late_after_s = 1e-3; });
  says("priority", [](RunnerSettings& s) { s.priority = 99; });
  says("speed_mm_per_s", [](RunnerSettings& s) { s.limits.speed_mm_per_s = -1.0; });
  says("force guard", [](RunnerSettings& s) { s.guard.max_force_N = 0.0; });
  says("a device damped by more than", [](RunnerSettings& s) {
    s.coupling = VirtualCouplingSettings{};
    s.coupling->stiffness_N_per_mm = 100.0;
  });
}
