// SPDX-License-Identifier: GPL-3.0-or-later
#include "step_loop.hpp"

#include "core/clock.hpp"
#include "handle.hpp"
#include "thread_setup.hpp"

#include <array>
#include <cmath>

namespace stylet {

StepLoop::StepLoop(Steppable& body, const BaseFollower& follower, const RunnerSettings& settings, Exchange& exchange,
                   LoopTimes& times)
    : body_(body),
      follower_(follower),
      settings_(settings),
      exchange_(exchange),
      times_(times),
      period_ns_(std::llround(settings.period_s * 1e9)) {}

double StepLoop::clock_s() const { return 1e-9 * static_cast<double>(monotonic_ns() - zero_ns_); }

bool StepLoop::wants_step(bool& single) {
  const std::int64_t asked = exchange_.single_steps.load(std::memory_order_acquire);
  single = false;
  if (!exchange_.paused.load(std::memory_order_acquire)) {
    single_done_ = asked;  // single steps requested while the simulation is not paused are ignored
    return true;
  }
  if (single_done_ == asked) return false;
  ++single_done_;
  single = true;
  return true;
}

void StepLoop::step(double dt, double now_s) {
  exchange_.input.fetch();
  const DeviceInput& input = exchange_.input.value();
  if (usable(input, now_s, settings_.late_after_s)) {
    follower_.follow(handle(input), outcome_.hand, dt);
  } else {
    follower_.hold();
    ++counters_.without_input;
  }
  const std::int64_t wall = monotonic_ns();
  const std::int64_t cpu = thread_cpu_ns();
  outcome_ = body_.step(follower_.base(), dt);
  const std::int64_t took = thread_cpu_ns() - cpu;
  times_.step_cpu.add(took);
  times_.step_wall.add(monotonic_ns() - wall);
  ++counters_.steps;
  if (!outcome_.trusted || !outcome_.hand.finite()) {
    outcome_.trusted = false;
    ++counters_.distrusted;
  }
  std::array<EventSnapshot, 32> events;
  const std::size_t count = body_.events(events);
  for (std::size_t k = 0; k < count; ++k) exchange_.events.push(events[k]);
  counters_.dropped_events = exchange_.events.dropped();
  if (!settings_.keep_steps) return;
  Step taken;
  if (!body_.record(taken)) return;
  taken.step_us = 1e-3 * static_cast<double>(took);
  exchange_.steps.push(taken);
  counters_.dropped_steps = exchange_.steps.dropped();
}

void StepLoop::publish(bool paused) {
  const double simulated_s = 1e-9 * static_cast<double>(simulated_ns_);
  StepResult& result = exchange_.result.draft();
  result.base = plain(follower_.base());
  result.velocity = plain(follower_.twist().velocity);
  result.angular_velocity = plain(follower_.twist().angular_velocity);
  result.hand = plain(outcome_.hand);
  result.clock_s = clock_s();
  result.simulated_s = simulated_s;
  result.good = outcome_.trusted && !paused;
  exchange_.result.publish();

  // The snapshot comes after the force, which is urgent.
  Snapshot& snapshot = exchange_.snapshot.draft();
  body_.describe(snapshot);
  snapshot.step.time_s = simulated_s;
  snapshot.clock_s = clock_s();
  snapshot.trusted = outcome_.trusted;
  snapshot.paused = paused;
  snapshot.counters = counters_;
  exchange_.snapshot.publish();
}

void StepLoop::run(std::int64_t clock_zero_ns, std::int64_t origin_ns) noexcept {
  const FlushDenormals flush;
  zero_ns_ = clock_zero_ns;
  follower_.start(body_.base());
  before_ = counters_;
  PeriodGrid grid(origin_ns, period_ns_, settings_.max_catch_up);
  while (true) {
    const std::int64_t due = grid.due_ns();
    sleep_until(due);
    if (exchange_.stop.load(std::memory_order_acquire)) return;
    const std::int64_t now = monotonic_ns();
    times_.step_lateness.add(now - due);
    grid.wake(now);
    bool single = false;
    if (wants_step(single)) {
      std::int64_t dt_ns = period_ns_;
      if (single) {
        grid.pass();
      } else {
        dt_ns = grid.take();
      }
      simulated_ns_ += dt_ns;
      step(1e-9 * static_cast<double>(dt_ns), 1e-9 * static_cast<double>(now - zero_ns_));
      said_paused_ = single;
      publish(single);
      if (grid.finish(monotonic_ns())) ++counters_.missed_deadlines;
    } else {
      grid.pass();
      if (!said_paused_) {
        said_paused_ = true;
        publish(true);
      }
      grid.finish(monotonic_ns());
    }
    counters_.skipped_periods = before_.skipped_periods + grid.skipped();
    counters_.lost_ns = before_.lost_ns + grid.lost_ns();
  }
}

}  // namespace stylet
