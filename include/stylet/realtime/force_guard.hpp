// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/realtime/wrench.hpp"

#include <cstdint>

namespace stylet {

/// Limits on force and torque of a device.
struct ForceGuardSettings {
  double max_force_N = 10.0;
  double max_torque_Nmm = 300.0;
  /// Largest rates of change of force and torque: fast enough for a puncture, which changes the force by newtons within
  /// milliseconds, but slower than a fault.
  double force_slew_N_per_s = 1000.0;
  double torque_slew_Nmm_per_s = 30000.0;
  double fade_s = 0.05;     ///< time from the first bad result to zero force
  double recover_s = 0.25;  ///< time from the first good result after a fade to the full force; at least fade_s
};

/// Makes a computed force safe for a device. The output is finite, within the limits, and never changes faster than the
/// slew rates, for any input. After a bad result (late, missing, not finite, or not trustworthy) the output fades
/// linearly to zero within fade_s; with good results it recovers over recover_s. If good and bad results alternate, the
/// force fades, because recovering takes longer. The output depends only on the inputs and dt; no clock is used.
class ForceGuard {
 public:
  /// Errors: settings that are not positive; recover_s below fade_s; slew rates too low to fade from the limits within
  /// fade_s.
  static Result<ForceGuard> create(const ForceGuardSettings& settings);

  /// @param wanted computed force and torque; if they are not finite, the result is bad whatever `good` says
  /// @param good false: the result is late, missing or not trustworthy
  /// @param dt [s] time since the last call; if it is not positive and finite, nothing changes
  /// @return force and torque to send; they hold until the next call
  const Wrench& filter(const Wrench& wanted, bool good, double dt);

  [[nodiscard]] const Wrench& sent() const { return sent_; }
  /// Factor on good results: 1 in normal operation, 0 after a fade.
  [[nodiscard]] double gain() const { return gain_; }

  /// Numbers of calls in which the input was changed.
  struct Counts {
    std::int64_t bad = 0;        ///< calls with a bad result
    std::int64_t fades = 0;      ///< fades that have begun
    std::int64_t saturated = 0;  ///< calls in which force or torque was above its limit
    std::int64_t slewed = 0;     ///< calls in which the change of force or torque was limited by a slew rate
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  explicit ForceGuard(const ForceGuardSettings& settings) : settings_(settings) {}
  void fade(double dt);

  ForceGuardSettings settings_;
  Wrench sent_;
  double gain_ = 0.0;       ///< starts at 0, so that the force also recovers slowly at the beginning
  bool fading_ = false;     ///< the last result was bad
  double fade_left_ = 0.0;  ///< [s] remaining time of the present fade
  Counts counts_;
};

}  // namespace stylet
