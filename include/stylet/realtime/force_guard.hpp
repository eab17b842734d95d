// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/realtime/wrench.hpp"

#include <cstdint>

namespace stylet {

/// Limits of what a device is given.
struct ForceGuardSettings {
  double max_force_N = 10.0;
  double max_torque_Nmm = 300.0;
  double force_slew_N_per_s = 1000.0;  ///< a puncture takes newtons within milliseconds; a fault takes them at once
  double torque_slew_Nmm_per_s = 30000.0;
  double fade_s = 0.05;     ///< from the first bad result until nothing is left
  double recover_s = 0.25;  ///< from the first good result after that until all of it is there; at least fade_s
};

/// Stands between a computed force and a device. What leaves it is finite, never above the limits, and never changes
/// faster than the slew rates, whatever comes in. A bad result fades what was there linearly to zero within fade_s;
/// good ones return over recover_s. Results that are good and bad by turns lose, because returning takes longer.
/// A function of its inputs and dt only: no clock inside.
class ForceGuard {
 public:
  /// Refuses settings that are not positive, and slew rates too slow to fade from the limits within fade_s.
  static Result<ForceGuard> create(const ForceGuardSettings& settings);

  /// @param wanted what was computed; anything that is not finite is bad whatever `good` says
  /// @param good false: the result is late, missing or not to be trusted
  /// @param dt [s] since the last call; nothing changes while it is not positive and finite
  /// @return what to send: held until the next call
  const Wrench& filter(const Wrench& wanted, bool good, double dt);

  [[nodiscard]] const Wrench& sent() const { return sent_; }
  /// Share of good results let through: 1 in normal operation, 0 after a fade.
  [[nodiscard]] double gain() const { return gain_; }

  // How often something was not let through as it came.
  struct Counts {
    std::int64_t bad = 0;        ///< calls with a bad result
    std::int64_t fades = 0;      ///< times a fade began
    std::int64_t saturated = 0;  ///< calls in which force or torque was above its limit
    std::int64_t slewed = 0;     ///< calls in which force or torque wanted to change faster than allowed
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  explicit ForceGuard(const ForceGuardSettings& settings) : settings_(settings) {}
  void fade(double dt);

  ForceGuardSettings settings_;
  Wrench sent_;
  double gain_ = 0.0;       ///< returns from nothing at the start, too
  bool fading_ = false;     ///< the last result was bad
  double fade_left_ = 0.0;  ///< [s] until the present fade is over
  Counts counts_;
};

}  // namespace stylet
