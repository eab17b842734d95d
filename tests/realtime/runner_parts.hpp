// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/runner.hpp"
#include "support/count_allocations.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <thread>
#include <vector>

namespace stylet::test {

/// Waits for something other threads do; a minute is for machines that have other things to do.
inline bool comes_true(const std::function<bool()>& condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return true;
}

/// A base on a spring along z, which does what a test tells it to.
struct SpringBody final : Steppable {
  double stiffness = 1.0;  ///< [N/mm]
  double drive = 0.0;      ///< [N s/mm] pushes along with its motion, which no needle in tissue does
  int events_per_step = 0;
  std::atomic<bool> hang{false};      ///< the step does not return until this is false
  std::atomic<bool> nonsense{false};  ///< forces that are not finite
  std::atomic<bool> distrust{false};  ///< steps without a balance
  std::atomic<bool> hanging{false};
  std::atomic<std::int64_t> steps{0};
  std::atomic<bool> flushes{false};  ///< denormal numbers are 0 in the loop's thread
  std::atomic<int> policy{-1};       ///< of the loop's thread
  std::vector<double> dts;           ///< room is taken before; read after stop()
  Pose at;
  Wrench hand;

  SpringBody() { dts.reserve(1'000'000); }

  [[nodiscard]] Pose base() const noexcept override { return at; }
  StepOutcome step(const Pose& base, double dt) noexcept override {
    while (hang.load()) {
      hanging.store(true);
      std::this_thread::yield();
    }
    hanging.store(false);
    volatile double small = std::numeric_limits<double>::min();
    flushes.store(small * 0.25 == 0.0);
    policy.store(sched_getscheduler(0));
    const double speed = (base.origin.z() - at.origin.z()) / dt;
    at = base;
    if (dts.size() < dts.capacity()) dts.push_back(dt);
    hand = {{0, 0, stiffness * at.origin.z() - drive * speed}, {0, 0, 0}};
    if (nonsense.load()) hand.force.x() = std::numeric_limits<double>::quiet_NaN();
    steps.fetch_add(1);
    return {hand, !distrust.load()};
  }
  void describe(Snapshot& out) noexcept override {
    out.step.base = at;
    out.step.hand_force_N = hand.force;
    out.step.torque_Nmm = hand.torque;
  }
  std::size_t events(std::span<EventSnapshot> out) noexcept override {
    const auto count = static_cast<std::size_t>(events_per_step);
    for (std::size_t k = 0; k < count; ++k)
      out[k] = {EventKind::puncture, 0.0, static_cast<double>(steps.load()), static_cast<double>(k), -1};
    return count;
  }
};

/// A hand that holds a handle somewhere on the z axis, and a protocol of what it felt.
struct TestHand final : Device {
  std::atomic<double> z{0.0};
  std::atomic<bool> valid{true};
  std::atomic<bool> stuck{false};  ///< the stamps of its samples stand still
  std::atomic<bool> broken{false};
  std::atomic<bool> sways{false};  ///< by 2 mm around z, once in 0.2 s
  std::atomic<std::int64_t> turns{0};
  double stamp = 0.0;
  std::vector<Wrench> felt;  ///< room is taken before; read after stop()

  TestHand() { felt.reserve(1'000'000); }

  [[nodiscard]] DeviceTraits traits() const override {
    return {
        .name = "test hand", .force = true, .torque = true, .damping_N_s_per_mm = 0.02, .damping_Nmm_s_per_rad = 10.0};
  }
  DeviceInput read(const DeviceTime& time) noexcept override {
    if (!stuck.load()) stamp = time.now_s;
    DeviceInput input;
    input.time_s = stamp;
    input.valid = valid.load();
    input.pose.origin[2] = broken.load() ? std::numeric_limits<double>::quiet_NaN() : z.load();
    if (sways.load()) input.pose.origin[2] += 2.0 * std::sin(10.0 * std::numbers::pi * time.now_s);
    return input;
  }
  void write(const Wrench& on_hand) noexcept override {
    if (felt.size() < felt.capacity()) felt.push_back(on_hand);
    turns.fetch_add(1);
  }
};

/// Passes everything on and counts what its thread allocates between the first call and the last.
struct CountingBody final : Steppable {
  std::unique_ptr<Steppable> inner;
  std::optional<AllocationCount> count;
  std::atomic<long> allocations{0};
  long own = 0;

  explicit CountingBody(std::unique_ptr<Steppable> body) : inner(std::move(body)) {}
  [[nodiscard]] Pose base() const noexcept override { return inner->base(); }
  StepOutcome step(const Pose& base, double dt) noexcept override {
    if (!count) count.emplace();
    allocations.store(count->count());
    return inner->step(base, dt);
  }
  void describe(Snapshot& out) noexcept override { inner->describe(out); }
  std::size_t events(std::span<EventSnapshot> out) noexcept override { return inner->events(out); }
};
struct CountingDevice final : Device {
  std::unique_ptr<Device> inner;
  std::optional<AllocationCount> count;
  std::atomic<long> allocations{0};

  explicit CountingDevice(std::unique_ptr<Device> device) : inner(std::move(device)) {}
  [[nodiscard]] DeviceTraits traits() const override { return inner->traits(); }
  DeviceInput read(const DeviceTime& time) noexcept override {
    if (!count) count.emplace();
    allocations.store(count->count());
    return inner->read(time);
  }
  void write(const Wrench& on_hand) noexcept override { inner->write(on_hand); }
};

/// Nothing asked of the operating system: other programs share the machine.
inline RunnerSettings plain_settings() {
  RunnerSettings s;
  s.realtime_scheduling = false;
  s.lock_memory = false;
  s.late_after_s = 0.1;                // a busy machine is late at times
  s.guard.force_slew_N_per_s = 500.0;  // 2 N in as many periods as a late turn may stand for: less than the tests press
  s.guard.fade_s = 0.02;
  s.guard.recover_s = 0.05;
  return s;
}

/// A runner on a spring and a hand, which stay within reach.
struct SpringRun {
  SpringBody* body = nullptr;
  TestHand* hand = nullptr;
  std::unique_ptr<RealtimeRunner> runner;

  explicit SpringRun(const RunnerSettings& settings = plain_settings(),
                     const std::function<void(SpringBody&)>& prepare = {}) {
    auto b = std::make_unique<SpringBody>();
    auto h = std::make_unique<TestHand>();
    if (prepare) prepare(*b);
    body = b.get();
    hand = h.get();
    auto made = RealtimeRunner::create(std::move(b), std::move(h), settings);
    if (!made) throw std::runtime_error(made.error().message());
    runner = std::move(*made);
  }
  void start() const { ASSERT_TRUE(runner->start().ok()); }

  /// Force on the hand now, along z.
  [[nodiscard]] double felt() const {
    runner->fetch_device();
    return runner->device_snapshot().sent.force[2];
  }
  /// After stop(): nothing the hand felt was above the limit, or changed faster than the slew rate from one turn to the
  /// next, however far apart those were.
  void expect_gentle() const {
    const RunnerSettings& s = runner->settings();
    const double most = s.guard.force_slew_N_per_s * s.period_s * s.max_catch_up + 1e-9;
    Vec3 before = Vec3::Zero();
    for (const Wrench& w : hand->felt) {
      ASSERT_TRUE(w.finite());
      ASSERT_LE(w.force.norm(), s.guard.max_force_N);
      ASSERT_LE((w.force - before).norm(), most);
      before = w.force;
    }
    EXPECT_EQ(before, Vec3::Zero()) << "the hand is left with nothing";
  }
};

}  // namespace stylet::test
