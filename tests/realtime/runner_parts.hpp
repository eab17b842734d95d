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

/// Waits, for at most a minute on busy machines, until a condition that other threads bring about is true.
inline bool comes_true(const std::function<bool()>& condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return true;
}

/// A body whose base is held by a spring along z; tests can make its steps fail in several ways.
struct SpringBody final : Steppable {
  double stiffness = 1.0;  ///< [N/mm]
  double drive = 0.0;  ///< [N s/mm] negative damping: pushes in the direction of motion, unlike any needle in tissue
  int events_per_step = 0;
  std::atomic<bool> hang{false};      ///< the step does not return until this is false
  std::atomic<bool> nonsense{false};  ///< steps return forces that are not finite
  std::atomic<bool> distrust{false};  ///< steps find no balance
  std::atomic<bool> hanging{false};
  std::atomic<std::int64_t> steps{0};
  std::atomic<bool> flushes{false};  ///< denormal numbers are treated as 0 in the loop's thread
  std::atomic<int> policy{-1};       ///< scheduling policy of the loop's thread
  std::vector<double> dts;           ///< dt of all steps; memory is reserved; to be read after stop()
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

/// A device whose handle is at a given place on the z axis, and which records the forces that it receives.
struct TestHand final : Device {
  std::atomic<double> z{0.0};
  std::atomic<bool> valid{true};
  std::atomic<bool> stuck{false};  ///< the time stamps of its samples stand still
  std::atomic<bool> broken{false};
  std::atomic<bool> sways{false};  ///< the handle oscillates by 2 mm around z with a period of 0.2 s
  std::atomic<std::int64_t> turns{0};
  double stamp = 0.0;
  std::vector<Wrench> felt;  ///< all forces received; memory is reserved; to be read after stop()

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

/// Forwards all calls and counts the allocations of its thread between the first call and the last.
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

/// Settings without requests to the operating system, since other programs share the machine.
inline RunnerSettings plain_settings() {
  RunnerSettings s;
  s.realtime_scheduling = false;
  s.lock_memory = false;
  s.late_after_s = 0.1;  // generous, since a busy machine may be late
  // 2 N in the largest number of periods of a late turn, which is less than the tests' forces.
  s.guard.force_slew_N_per_s = 500.0;
  s.guard.fade_s = 0.02;
  s.guard.recover_s = 0.05;
  return s;
}

/// A runner with a SpringBody and a TestHand, to which the test keeps access.
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

  /// Present force on the hand, along z.
  [[nodiscard]] double felt() const {
    runner->fetch_device();
    return runner->device_snapshot().sent.force[2];
  }
  /// To be called after stop(): checks that the force on the hand never exceeded the limit, and never changed faster
  /// than the slew rate between two turns, even late ones.
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
