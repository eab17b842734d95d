// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/wrench.hpp"

#include <cstdint>
#include <string>

namespace stylet {

/// The moment of a call to a device, on two clocks that start together. No device asks the system for the time.
struct DeviceTime {
  double now_s = 0.0;        ///< runs on whatever happens: stamps of samples
  double simulated_s = 0.0;  ///< stands while the simulation is paused: scripts follow it
};

/// What a device says.
struct DeviceInput {
  double time_s = 0.0;        ///< on DeviceTime::now_s, when the pose was measured
  bool valid = false;         ///< the pose can be used: tracked, within the workspace
  PlainPose pose;             ///< of the handle, where it wants the needle's base: LPS
  std::uint32_t buttons = 0;  ///< bit k = button k is down
};

/// What the device can do; read once, before the loop starts.
struct DeviceTraits {
  std::string name;
  bool force = false;   ///< feels forces
  bool torque = false;  ///< feels torques
  /// Physical damping of the handle, the least in any direction: what keeps a stiff coupling passive.
  double damping_N_s_per_mm = 0.0;
  double damping_Nmm_s_per_rad = 0.0;
};

/// Something that a hand moves, and that may push back: a haptic device, a mouse, a tracked needle, a script. The loop
/// calls read() and write() from one thread, in turn, once a period; both return at once (no waiting, allocating,
/// throwing): a driver that has to wait for its hardware does so in a thread of its own. Mapping the device's workspace
/// to patient coordinates is the device's business.
class Device {
 public:
  virtual ~Device() = default;

  [[nodiscard]] virtual DeviceTraits traits() const = 0;

  /// The newest sample there is.
  virtual DeviceInput read(const DeviceTime& time) noexcept = 0;

  /// Force and torque on the hand, held until the next call. Already limited; always finite.
  virtual void write(const Wrench& on_hand) noexcept = 0;
};

}  // namespace stylet
