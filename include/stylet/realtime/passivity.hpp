// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/wrench.hpp"

#include <cstdint>

namespace stylet {

/// Passivity controller: observes the energy that goes to the hand, and dissipates any excess by damping the handle.
///   E ← E − (sent force · motion of the handle while it was held)
/// is the energy that the hand has put in and not got back; it is exact, because a device holds the force between two
/// samples. Needle, tissue and coupling cannot give back more than they were given, so E < 0 is an effect of sampling,
/// delay or rounding. Then damping α is added for one period, just large enough to dissipate −E,
///   α = −E / (T (|v|² + ℓ²|ω|²)),
/// but at most as much as the device can be damped by.
/// @cite B. Hannaford, J.-H. Ryu, "Time-domain passivity control of haptic interfaces", IEEE Transactions on Robotics
/// and Automation 18 (2002) 1–10
class PassivityControl {
 public:
  struct Settings {
    double max_damping_N_s_per_mm = 0.0;  ///< VirtualCoupling::spare_damping_N_s_per_mm(); 0 = observe only
    double lever_mm = 1.0;                ///< ℓ, VirtualCoupling::lever_mm()
    /// Upper bound of E: energy that was dissipated in tissue long ago must not hide a present excess. It must be more
    /// than coupling, needle and tissue together can store.
    double credit_Nmm = 200.0;
  };

  explicit PassivityControl(const Settings& settings) : settings_(settings) {}

  /// Updates E by a period. @param sent force on the hand during the whole period @param moved [mm], LPS, and
  /// @param turned [rad], LPS, translation and rotation of the handle in this period
  void observe(const Wrench& sent, const Vec3& moved, const Vec3& turned);

  /// @param on_hand computed force and torque on the hand @param handle velocity of the handle @param dt [s] period
  /// @return force and torque to send, with damping added if E < 0
  Wrench control(const Wrench& on_hand, const Twist& handle, double dt);

  [[nodiscard]] double energy_Nmm() const { return energy_; }      ///< E
  [[nodiscard]] double lowest_Nmm() const { return lowest_; }      ///< minimum of E, ≤ 0
  [[nodiscard]] std::int64_t active() const { return active_; }    ///< periods in which damping was added
  [[nodiscard]] std::int64_t limited() const { return limited_; }  ///< periods that needed more than max_damping

 private:
  Settings settings_;
  double energy_ = 0.0;
  double lowest_ = 0.0;
  std::int64_t active_ = 0;
  std::int64_t limited_ = 0;
};

}  // namespace stylet
