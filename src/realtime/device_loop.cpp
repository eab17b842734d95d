// SPDX-License-Identifier: GPL-3.0-or-later
#include "device_loop.hpp"

#include "core/clock.hpp"
#include "handle.hpp"
#include "thread_setup.hpp"

#include <cmath>

namespace stylet {

namespace {

PassivityControl::Settings passivity_settings(const std::optional<VirtualCoupling>& coupling) {
  if (!coupling) return {};  // without a coupling the device's damping is not checked, so energy is only observed
  return {.max_damping_N_s_per_mm = coupling->spare_damping_N_s_per_mm(), .lever_mm = coupling->lever_mm()};
}

}  // namespace

DeviceLoop::DeviceLoop(Device& device, const std::optional<VirtualCoupling>& coupling, const ForceGuard& guard,
                       const RunnerSettings& settings, Exchange& exchange, LoopTimes& times)
    : device_(device),
      coupling_(coupling),
      guard_(guard),
      passivity_(passivity_settings(coupling)),
      settings_(settings),
      exchange_(exchange),
      times_(times),
      period_ns_(std::llround(settings.period_s * 1e9)) {}

/// Updates velocity and energy by the handle's motion since the last turn. If the handle was not tracked in the last
/// turn, its motion is unknown and taken as zero.
void DeviceLoop::follow_handle(const DeviceInput& input, double dt) {
  const Pose now = handle(input);
  twist_ = {};
  if (tracked_) {
    const Vec3 moved = now.origin - handle_.origin;
    const Vec3 turned = rotation_between(handle_.rotation, now.rotation);
    passivity_.observe(guard_.sent(), moved, turned);
    twist_ = {moved / dt, turned / dt};
  }
  handle_ = now;
  tracked_ = true;
}

Wrench DeviceLoop::on_hand() const {
  const StepResult& result = exchange_.result.value();
  const Wrench on_base = coupling_ ? coupling_->on_base(handle_, twist_, pose(result.base),
                                                        {vec3(result.velocity), vec3(result.angular_velocity)})
                                   : wrench(result.hand);
  return {-on_base.force, -on_base.torque};
}

void DeviceLoop::turn(double now_s, double dt, bool stopping) {
  exchange_.result.fetch();
  const StepResult& result = exchange_.result.value();
  const DeviceInput input = device_.read({.now_s = now_s, .simulated_s = result.simulated_s});
  exchange_.input.write(input);

  const bool tracked = usable(input, now_s, settings_.late_after_s);
  if (tracked) {
    follow_handle(input, dt);
  } else {
    tracked_ = false;
    twist_ = {};
  }
  const bool good = tracked && !stopping && result.good && now_s - result.clock_s <= settings_.late_after_s;
  const Wrench wanted = good ? passivity_.control(on_hand(), twist_, dt) : Wrench{};
  const Wrench& sent = guard_.filter(wanted, good, dt);
  device_.write(sent);

  exchange_.device.write({.clock_s = now_s,
                          .input = input,
                          .sent = plain(sent),
                          .good = good,
                          .gain = guard_.gain(),
                          .guard = guard_.counts(),
                          .energy_Nmm = passivity_.energy_Nmm(),
                          .lowest_energy_Nmm = passivity_.lowest_Nmm(),
                          .damped = passivity_.active(),
                          .damped_too_little = passivity_.limited()});
}

void DeviceLoop::run(std::int64_t clock_zero_ns, std::int64_t origin_ns) noexcept {
  const FlushDenormals flush;
  PeriodGrid grid(origin_ns, period_ns_, settings_.max_catch_up);
  tracked_ = false;
  const auto nothing_sent = [this] { return guard_.sent().force.isZero(0.0) && guard_.sent().torque.isZero(0.0); };
  while (true) {
    const std::int64_t due = grid.due_ns();
    sleep_until(due);
    const std::int64_t now = monotonic_ns();
    const bool stopping = exchange_.stop.load(std::memory_order_acquire);
    if (stopping && nothing_sent()) break;
    times_.device_lateness.add(now - due);
    grid.wake(now);
    turn(1e-9 * static_cast<double>(now - clock_zero_ns), 1e-9 * static_cast<double>(grid.take()), stopping);
    const std::int64_t done = monotonic_ns();
    times_.device_wall.add(done - now);
    grid.finish(done);
  }
  device_.write({});
}

}  // namespace stylet
