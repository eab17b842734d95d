// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/wrench.hpp"

#include <cstdint>

namespace stylet {

/// Watches the energy that goes to the hand, and takes back what was given too much by damping the handle.
///   E ← E − (sent force · motion of the handle while it was held)
/// is what the hand has put in and not got back; exact, because a device holds the force between two samples. Needle,
/// tissue and coupling cannot give back more than they were given, so E < 0 is made by sampling, delay or numbers. Then
/// damping α is added for one period, so large that it takes in what is owed,
///   α = −E / (T (|v|² + ℓ²|ω|²)),
/// but not more than the device can be damped by.
/// @cite B. Hannaford, J.-H. Ryu, "Time-domain passivity control of haptic interfaces", IEEE Transactions on Robotics
/// and Automation 18 (2002) 1–10
class PassivityControl {
 public:
  struct Settings {
    double max_damping_N_s_per_mm = 0.0;  ///< VirtualCoupling::spare_damping_N_s_per_mm(); 0 = watch only
    double lever_mm = 1.0;                ///< ℓ, VirtualCoupling::lever_mm()
    /// Energy put in counts up to this much: what was lost in tissue long ago must not hide what happens now. More than
    /// coupling, needle and tissue together store.
    double credit_Nmm = 200.0;
  };

  explicit PassivityControl(const Settings& settings) : settings_(settings) {}

  /// Books a period. @param sent on the hand, through the whole period @param moved [mm] @param turned [rad] of the
  /// handle meanwhile, LPS
  void observe(const Wrench& sent, const Vec3& moved, const Vec3& turned);

  /// @param on_hand what is to be sent @param handle its motion @param dt [s] period
  /// @return the same with damping added where energy is owed
  Wrench control(const Wrench& on_hand, const Twist& handle, double dt);

  [[nodiscard]] double energy_Nmm() const { return energy_; }      ///< E
  [[nodiscard]] double lowest_Nmm() const { return lowest_; }      ///< its minimum so far, ≤ 0
  [[nodiscard]] std::int64_t active() const { return active_; }    ///< periods in which damping was added
  [[nodiscard]] std::int64_t limited() const { return limited_; }  ///< of those, with less than was owed

 private:
  Settings settings_;
  double energy_ = 0.0;
  double lowest_ = 0.0;
  std::int64_t active_ = 0;
  std::int64_t limited_ = 0;
};

}  // namespace stylet
