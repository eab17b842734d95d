// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/runner.hpp"

#include "core/clock.hpp"
#include "device_loop.hpp"
#include "step_loop.hpp"
#include "thread_setup.hpp"

#include <fmt/format.h>

#include <cmath>
#include <future>
#include <system_error>
#include <thread>

namespace stylet {

namespace {

/// Time from start() to the first turn, enough for both threads to be waiting for it.
constexpr std::int64_t kLead_ns = 2'000'000;

Result<> in_range(const char* name, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return Ok{};
  return input_error(fmt::format("real-time runner, {}", name),
                     fmt::format("{} {} is outside {} … {} {}", value, unit, least, most, unit),
                     fmt::format("Give {} … {}", least, most));
}

Result<> check(const RunnerSettings& s) {
  if (auto ok = in_range("period_s", s.period_s, 5e-5, 0.1, "s"); !ok) return ok;
  if (auto ok = in_range("max_catch_up", s.max_catch_up, 1, 1000, "periods"); !ok) return ok;
  if (auto ok = in_range("late_after_s", s.late_after_s, 2.0 * s.period_s, 1.0, "s"); !ok) return ok;
  if (auto ok = in_range("limits.speed_mm_per_s", s.limits.speed_mm_per_s, 1e-3, 1e4, "mm/s"); !ok) return ok;
  if (auto ok = in_range("limits.turn_rad_per_s", s.limits.turn_rad_per_s, 1e-3, 1e3, "rad/s"); !ok) return ok;
  return in_range("priority", s.priority, 1, 98, "");
}

}  // namespace

struct RealtimeRunner::Parts {
  Parts(std::unique_ptr<Steppable> body_, std::unique_ptr<Device> device_, const RunnerSettings& settings_,
        const std::optional<VirtualCoupling>& coupling, const ForceGuard& guard)
      : settings(settings_),
        body(std::move(body_)),
        device(std::move(device_)),
        times(std::llround(settings.period_s * 1e9)),
        step_loop(*body, coupling ? BaseFollower(settings.limits, *coupling) : BaseFollower(settings.limits), settings,
                  exchange, times),
        device_loop(*device, coupling, guard, settings, exchange, times) {}

  /// Prepares the calling thread before its first turn.
  [[nodiscard]] ThreadRights set_up(int priority) const {
    ThreadRights granted;
    prepare_thread();
    if (settings.realtime_scheduling) request_realtime_scheduling(priority, granted);
    return granted;
  }
  void join() {
    for (std::thread* thread : {&device_thread, &step_thread}) {
      if (thread->joinable()) thread->join();
    }
    memory.reset();
  }

  RunnerSettings settings;
  std::unique_ptr<Steppable> body;
  std::unique_ptr<Device> device;
  Exchange exchange;
  LoopTimes times;
  StepLoop step_loop;
  DeviceLoop device_loop;
  ThreadRights rights;
  std::int64_t zero_ns = monotonic_ns();
  std::optional<LockedMemory> memory;
  std::thread step_thread;
  std::thread device_thread;
};

Result<std::unique_ptr<RealtimeRunner>> RealtimeRunner::create(std::unique_ptr<Steppable> body,
                                                               std::unique_ptr<Device> device,
                                                               const RunnerSettings& settings) {
  if (auto ok = check(settings); !ok) return ok.error();
  auto guard = ForceGuard::create(settings.guard);
  if (!guard) return guard.error();
  std::optional<VirtualCoupling> coupling;
  if (settings.coupling) {
    auto made = VirtualCoupling::create(*settings.coupling, device->traits(), settings.period_s);
    if (!made) return made.error();
    coupling = *made;
  }
  return std::unique_ptr<RealtimeRunner>(
      new RealtimeRunner(std::make_unique<Parts>(std::move(body), std::move(device), settings, coupling, *guard)));
}

RealtimeRunner::RealtimeRunner(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
RealtimeRunner::~RealtimeRunner() { stop(); }

bool RealtimeRunner::running() const { return parts_->step_thread.joinable(); }

Result<> RealtimeRunner::start() {
  Parts& p = *parts_;
  if (running()) return failure("real-time runner", "it is already running", "Stop it first");
  p.exchange.stop.store(false, std::memory_order_release);
  // A step is due an eighth of a period after the device's turn, so that it uses the sample of the same period.
  const std::int64_t after = std::llround(p.settings.period_s * 1e9) / 8;
  std::promise<std::int64_t> first_turn;
  const std::shared_future<std::int64_t> origin = first_turn.get_future().share();
  std::promise<ThreadRights> device_promise;
  std::promise<ThreadRights> step_promise;
  std::future<ThreadRights> of_device = device_promise.get_future();
  std::future<ThreadRights> of_step = step_promise.get_future();
  try {
    p.device_thread = std::thread([&p, origin, granted = std::move(device_promise)]() mutable {
      granted.set_value(p.set_up(p.settings.priority + 1));
      p.device_loop.run(p.zero_ns, origin.get());
    });
    p.step_thread = std::thread([&p, origin, after, granted = std::move(step_promise)]() mutable {
      granted.set_value(p.set_up(p.settings.priority));
      p.step_loop.run(p.zero_ns, origin.get() + after);
    });
  } catch (const std::system_error& error) {
    p.exchange.stop.store(true, std::memory_order_release);
    first_turn.set_value(monotonic_ns());
    p.join();
    return failure("real-time runner", fmt::format("the system provides no thread: {}", error.code().message()),
                   "Raise the limit on the number of threads");
  }
  p.rights = of_step.get();
  const ThreadRights device_rights = of_device.get();
  p.rights.realtime_scheduling = p.rights.realtime_scheduling && device_rights.realtime_scheduling;
  if (p.rights.scheduling_error == 0) p.rights.scheduling_error = device_rights.scheduling_error;
  p.memory.emplace(p.settings.lock_memory);  // after both threads have started, so that their stacks are locked too
  p.rights.memory_locked = p.memory->locked();
  p.rights.memory_error = p.memory->error();
  p.rights.denormals_flushed = FlushDenormals::available();
  first_turn.set_value(monotonic_ns() + kLead_ns);
  return Ok{};
}

void RealtimeRunner::stop() {
  parts_->exchange.stop.store(true, std::memory_order_release);
  parts_->join();
}

void RealtimeRunner::pause() { parts_->exchange.paused.store(true, std::memory_order_release); }
void RealtimeRunner::resume() { parts_->exchange.paused.store(false, std::memory_order_release); }
void RealtimeRunner::single_step(int count) {
  parts_->exchange.single_steps.fetch_add(count, std::memory_order_acq_rel);
}

bool RealtimeRunner::fetch_snapshot() { return parts_->exchange.snapshot.fetch(); }
const Snapshot& RealtimeRunner::snapshot() const { return parts_->exchange.snapshot.value(); }
bool RealtimeRunner::fetch_device() { return parts_->exchange.device.fetch(); }
const DeviceSnapshot& RealtimeRunner::device_snapshot() const { return parts_->exchange.device.value(); }
std::size_t RealtimeRunner::take_events(std::span<EventSnapshot> out) { return parts_->exchange.events.pop(out); }
std::size_t RealtimeRunner::take_steps(std::span<Step> out) { return parts_->exchange.steps.pop(out); }

std::unique_ptr<RunnerTimes> RealtimeRunner::times() const {
  const LoopTimes& t = parts_->times;
  return std::make_unique<RunnerTimes>(RunnerTimes{t.step_cpu.snapshot(), t.step_wall.snapshot(),
                                                   t.step_lateness.snapshot(), t.device_wall.snapshot(),
                                                   t.device_lateness.snapshot()});
}

const ThreadRights& RealtimeRunner::rights() const { return parts_->rights; }
const RunnerSettings& RealtimeRunner::settings() const { return parts_->settings; }
Steppable& RealtimeRunner::body() { return *parts_->body; }

}  // namespace stylet
