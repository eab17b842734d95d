// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/wrench.hpp"

#include <cstdint>
#include <string>

namespace stylet {

/// The time of a call to a device, on two clocks that start together. A device must not use the system's clock.
struct DeviceTime {
  double now_s = 0.0;        ///< runs always; for the time stamps of samples
  double simulated_s = 0.0;  ///< stops while the simulation is paused; for scripts
};

/// A sample of a device.
struct DeviceInput {
  double time_s = 0.0;        ///< when the pose was measured, on the clock of DeviceTime::now_s
  bool valid = false;         ///< the pose is usable: the handle is tracked and within the workspace
  PlainPose pose;             ///< pose of the handle, LPS: desired pose of the needle's base
  std::uint32_t buttons = 0;  ///< bit k = button k is down
};

/// Capabilities of a device; read once, before the loop starts.
struct DeviceTraits {
  std::string name;
  bool force = false;   ///< the device can exert forces
  bool torque = false;  ///< the device can exert torques
  /// Physical damping of the handle, in the direction in which it is smallest. It keeps a stiff coupling passive.
  double damping_N_s_per_mm = 0.0;
  double damping_Nmm_s_per_rad = 0.0;
};

/// Interface of an input device that a hand moves and that may exert forces on it: a haptic device, a mouse, a tracked
/// needle, a script. The loop calls read() and write() alternately from one thread, once per period. Both must return
/// immediately, without waiting, allocating or throwing; a driver that has to wait for its hardware needs a thread of
/// its own. The implementation maps the device's workspace to patient coordinates.
class Device {
 public:
  virtual ~Device() = default;

  [[nodiscard]] virtual DeviceTraits traits() const = 0;

  /// The newest sample.
  virtual DeviceInput read(const DeviceTime& time) noexcept = 0;

  /// Sets force and torque on the hand, to be held until the next call. They are always finite and within the limits.
  virtual void write(const Wrench& on_hand) noexcept = 0;
};

}  // namespace stylet
