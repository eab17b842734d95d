// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/realtime/device.hpp"
#include "stylet/realtime/wrench.hpp"

namespace stylet {

/// Spring and damper between the device's handle and the needle's base, equal in all directions.
struct VirtualCouplingSettings {
  double stiffness_N_per_mm = 0.5;
  double damping_N_s_per_mm = 0.001;
  double stiffness_Nmm_per_rad = 200.0;
  double damping_Nmm_s_per_rad = 0.05;
};

/// Virtual coupling: a spring and a damper between the handle and the needle's base. The hand never feels a stiffness
/// above that of the spring, however stiff needle and tissue are; this makes a sampled device stable.
/// @cite J. E. Colgate, M. C. Stanley, J. M. Brown, "Issues in the haptic display of tool use", IROS 1995, 140–145
class VirtualCoupling {
 public:
  /// Makes a coupling. Returns an error if it could supply energy to the hand merely because the loop samples the pose
  /// and holds the force for a period. The condition of passivity is
  ///   b > K T / 2 + |B|
  /// with the coupling's stiffness K and damping B and the handle's physical damping b, for translation and, on devices
  /// with torques, for rotation.
  /// @param period_s [s] T, period of the loop that reads the device and sends the force; add twice any further delay
  /// @cite J. E. Colgate, G. G. Schenkel, "Passivity of a class of sampled-data systems: application to haptic
  /// interfaces", Journal of Robotic Systems 14 (1997) 37–47: the virtual wall
  static Result<VirtualCoupling> create(const VirtualCouplingSettings& settings, const DeviceTraits& device,
                                        double period_s);

  /// Force and torque that the coupling exerts on the base; the hand feels the opposite.
  [[nodiscard]] Wrench on_base(const Pose& device, const Twist& device_twist, const Pose& base,
                               const Twist& base_twist) const;

  [[nodiscard]] const VirtualCouplingSettings& settings() const { return settings_; }

  /// Damping [N s/mm] that may be added to the coupling before the condition of create() fails. The damping that
  /// may be added for rotation [N mm s/rad] is lever_mm()² times this value.
  [[nodiscard]] double spare_damping_N_s_per_mm() const { return spare_damping_; }
  /// √(rotational / translational stiffness) [mm], by which angles are converted to lengths.
  [[nodiscard]] double lever_mm() const;

 private:
  VirtualCoupling(const VirtualCouplingSettings& settings, double spare) : settings_(settings), spare_damping_(spare) {}
  VirtualCouplingSettings settings_;
  double spare_damping_ = 0.0;
};

}  // namespace stylet
