// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"
#include "stylet/realtime/force_guard.hpp"
#include "stylet/sim/recording.hpp"
#include "stylet/sim/tip_watch.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace stylet {

/// Counters of the loop since the runner was created.
struct LoopCounters {
  std::int64_t steps = 0;
  std::int64_t missed_deadlines = 0;  ///< steps that ended after the next one was due: woken late, or too slow
  std::int64_t skipped_periods = 0;   ///< periods without a step
  std::int64_t lost_ns = 0;           ///< time by which simulated time lags the clock, lost beyond max_catch_up
  std::int64_t distrusted = 0;        ///< steps whose force was not passed to the device
  std::int64_t without_input = 0;     ///< steps with an invalid or old sample of the device: the base stayed in place
  std::int64_t dropped_events = 0;    ///< events that did not fit into the queue
  std::int64_t dropped_steps = 0;     ///< steps that did not fit into the queue, with RunnerSettings::keep_steps
};

/// A contact: a place at which shaft or tip holds the tissue.
struct ContactSnapshot {
  Triple position{};  ///< [mm] LPS, position in the deformed tissue
  Triple force{};     ///< [N] LPS, force of the needle on the tissue
  double s = 0.0;     ///< [mm] arc length on the needle, from its base
  bool sticking = false;
  bool tip = false;
};

/// A force on a point of the tissue.
struct ForceSnapshot {
  std::int32_t tet = -1;            ///< element of the mesh
  std::array<double, 4> weights{};  ///< barycentric coordinates in the element
  Triple force{};                   ///< [N] LPS
  Triple along{};                   ///< TissueForce::along
  Triple lasting{};                 ///< TissueForce::lasting
};

/// The state after a step with everything that a display needs, of fixed size.
struct Snapshot {
  static constexpr std::size_t kCentreline = 65;
  static constexpr std::size_t kContacts = 128;
  /// More than contacts, since lasting forces remain at places that the needle has left, and other needles may rest.
  static constexpr std::size_t kForces = 512;
  static constexpr std::size_t kRegions = 16;
  static constexpr std::size_t kResting = 16;
  static constexpr std::size_t kRestingPoints = 17;
  using RestingShape = std::array<Triple, kRestingPoints>;

  Step step;             ///< the last step; its time_s counts from the creation of the runner
  double clock_s = 0.0;  ///< end of the step on the runner's clock, which starts with the creation of the runner
  std::array<Triple, kCentreline> centreline{};       ///< [mm] LPS, base to tip, evenly spaced
  int resting_count = 0;                              ///< used entries of `resting`
  std::array<RestingShape, kResting> resting{};       ///< [mm] LPS, needles at rest, base to tip, evenly spaced
  int contact_count = 0;                              ///< used entries of `contacts`
  int contacts_left_out = 0;                          ///< contacts that did not fit
  std::array<ContactSnapshot, kContacts> contacts{};  ///< the tip first, if it touches tissue
  int force_count = 0;                                ///< used entries of `forces`
  int forces_left_out = 0;                            ///< forces that did not fit
  double forces_left_out_N = 0.0;                     ///< sum of their magnitudes
  std::array<ForceSnapshot, kForces> forces{};        ///< all forces that displace the tissue, for a DisplayField
  int region_count = 0;                               ///< used entries of `regions`
  std::array<std::int16_t, kRegions> regions{};       ///< regions of the mesh in which the needle is; the tip's first
  std::optional<TipError> tip_error;                  ///< TipWatch::deepest()
  bool trusted = false;                               ///< the force may be sent to a device
  bool paused = false;                                ///< the simulation stands still until resume() or single_step()
  LoopCounters counters;
};

/// Input and output of the device in one period.
struct DeviceSnapshot {
  double clock_s = 0.0;  ///< time of the period on the runner's clock
  DeviceInput input;
  PlainWrench sent;   ///< force and torque on the hand
  bool good = false;  ///< the newest result was good enough to be sent
  double gain = 0.0;  ///< ForceGuard::gain()
  ForceGuard::Counts guard;
  double energy_Nmm = 0.0;             ///< energy that the hand has put in and not got back (PassivityControl)
  double lowest_energy_Nmm = 0.0;      ///< minimum of energy_Nmm
  std::int64_t damped = 0;             ///< periods in which the passivity control added damping
  std::int64_t damped_too_little = 0;  ///< periods in which the limit on damping was reached
};

/// An event of a step as plain data.
struct EventSnapshot {
  EventKind kind{};
  double time_s = 0.0;  ///< simulated time since the creation of the simulation
  double depth_mm = 0.0;
  double force_N = 0.0;
  int region = -1;  ///< region of the mesh; -1 if the event has none
};

}  // namespace stylet
