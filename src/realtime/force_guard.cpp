// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/force_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// A vector shortened to a length, with its direction kept. The result is slightly shorter, so that rounding cannot
/// exceed the limit.
Vec3 shortened(const Vec3& v, double length, bool& cut) {
  const double now = v.stableNorm();
  if (now <= length) return v;
  cut = true;
  constexpr double below = 1.0 - 1e-14;
  return v / now * (length * below);
}

Vec3 moved(const Vec3& from, const Vec3& to, double most, bool& cut) { return from + shortened(to - from, most, cut); }

}  // namespace

Result<ForceGuard> ForceGuard::create(const ForceGuardSettings& s) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  const struct {
    const char* name;
    double value;
  } all[] = {{"max_force_N", s.max_force_N},
             {"max_torque_Nmm", s.max_torque_Nmm},
             {"force_slew_N_per_s", s.force_slew_N_per_s},
             {"torque_slew_Nmm_per_s", s.torque_slew_Nmm_per_s},
             {"fade_s", s.fade_s},
             {"recover_s", s.recover_s}};
  for (const auto& [name, value] : all) {
    if (!positive(value))
      return input_error(fmt::format("force guard, {}", name), fmt::format("{} is not above 0", value),
                         "Give a number above 0");
  }
  if (s.recover_s < s.fade_s)
    return input_error(
        "force guard, recover_s",
        fmt::format("{} s is shorter than fade_s = {} s, so that alternating good and bad results would reach the hand",
                    s.recover_s, s.fade_s),
        "Give at least fade_s");
  const double fade_s = std::max(s.max_force_N / s.force_slew_N_per_s, s.max_torque_Nmm / s.torque_slew_Nmm_per_s);
  // The small tolerance accepts a slew rate that is exactly sufficient, in spite of rounding.
  if (fade_s > s.fade_s * (1.0 + 1e-12))
    return input_error(
        "force guard, fade_s",
        fmt::format("{} s is too short: {} N at {} N/s and {} N mm at {} N mm/s take {} s to fade", s.fade_s,
                    s.max_force_N, s.force_slew_N_per_s, s.max_torque_Nmm, s.torque_slew_Nmm_per_s, fade_s),
        "Raise fade_s or the slew rates, or lower the limits");
  return ForceGuard(s);
}

void ForceGuard::fade(double dt) {
  if (!fading_) {
    fading_ = true;
    fade_left_ = settings_.fade_s;
    ++counts_.fades;
  }
  // The output is proportional to the remaining time: both vectors fall linearly and keep their directions.
  const double left = std::max(0.0, fade_left_ - dt);
  const double keep = fade_left_ > 0.0 ? left / fade_left_ : 0.0;
  fade_left_ = left;
  gain_ = std::max(0.0, gain_ - dt / settings_.fade_s);
  bool cut = false;
  sent_.force = moved(sent_.force, keep * sent_.force, settings_.force_slew_N_per_s * dt, cut);
  sent_.torque = moved(sent_.torque, keep * sent_.torque, settings_.torque_slew_Nmm_per_s * dt, cut);
}

const Wrench& ForceGuard::filter(const Wrench& wanted, bool good, double dt) {
  good = good && wanted.finite();
  if (!good) ++counts_.bad;
  if (!(dt > 0.0) || !std::isfinite(dt)) return sent_;
  if (!good) {
    fade(dt);
    return sent_;
  }
  fading_ = false;
  gain_ = std::min(1.0, gain_ + dt / settings_.recover_s);
  bool saturated = false;
  bool slewed = false;
  const Vec3 force = gain_ * shortened(wanted.force, settings_.max_force_N, saturated);
  const Vec3 torque = gain_ * shortened(wanted.torque, settings_.max_torque_Nmm, saturated);
  sent_.force = moved(sent_.force, force, settings_.force_slew_N_per_s * dt, slewed);
  sent_.torque = moved(sent_.torque, torque, settings_.torque_slew_Nmm_per_s * dt, slewed);
  counts_.saturated += saturated ? 1 : 0;
  counts_.slewed += slewed ? 1 : 0;
  return sent_;
}

}  // namespace stylet
