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

/// What the loop has counted since the runner was made.
struct LoopCounters {
  std::int64_t steps = 0;
  std::int64_t missed_deadlines = 0;  ///< steps that ended after the next one was due: woken late, or too long
  std::int64_t skipped_periods = 0;   ///< points of the grid without a step
  std::int64_t lost_ns = 0;           ///< time beyond the catch-up limit: the clock is ahead of simulated time by it
  std::int64_t distrusted = 0;        ///< steps whose force was not let through
  std::int64_t without_input = 0;     ///< steps with an invalid or old sample of the device: the base stayed
  std::int64_t dropped_events = 0;    ///< the queue was full
  std::int64_t dropped_steps = 0;     ///< RunnerSettings::keep_steps: the queue was full
};

/// A place where shaft or tip holds the tissue.
struct ContactSnapshot {
  Triple position{};  ///< [mm] LPS, deformed
  Triple force{};     ///< [N] LPS, on the tissue
  double s = 0.0;     ///< [mm] arc length on the needle
  bool sticking = false;
  bool tip = false;
};

/// A force on a point of the tissue.
struct ForceSnapshot {
  std::int32_t tet = -1;            ///< element of the mesh
  std::array<double, 4> weights{};  ///< barycentric, of the element's corners
  Triple force{};                   ///< [N] LPS
  Triple along{};                   ///< TissueForce::along
  Triple lasting{};                 ///< TissueForce::lasting
};

/// Everything a display needs of one step, of fixed size.
struct Snapshot {
  static constexpr std::size_t kCentreline = 65;
  static constexpr std::size_t kContacts = 128;
  static constexpr std::size_t kForces = 256;  ///< viscous tissue remembers points left behind
  static constexpr std::size_t kRegions = 16;

  Step step;             ///< its time is simulated since the runner was made, its base where the needle's base is
  double clock_s = 0.0;  ///< on the runner's clock, which starts when it is made: when the step was over
  std::array<Triple, kCentreline> centreline{};  ///< [mm] LPS, base to tip, evenly spaced
  int contact_count = 0;                         ///< used entries of `contacts`
  int contacts_left_out = 0;
  std::array<ContactSnapshot, kContacts> contacts{};  ///< tip first when it touches
  int force_count = 0;                                ///< used entries of `forces`
  int forces_left_out = 0;                            ///< there was no room for
  std::array<ForceSnapshot, kForces> forces{};   ///< all that displaces the tissue: with them a DisplayField has it
  int region_count = 0;                          ///< used entries of `regions`
  std::array<std::int16_t, kRegions> regions{};  ///< of the mesh, that the needle is in; the tip's first
  std::optional<TipError> tip_error;             ///< TipWatch::deepest()
  bool trusted = false;                          ///< the force may go to a device
  bool paused = false;                           ///< nothing moves until resume() or single_step()
  LoopCounters counters;
};

/// What goes to the device and comes from it, once a period: plain data.
struct DeviceSnapshot {
  double clock_s = 0.0;  ///< on the runner's clock
  DeviceInput input;
  PlainWrench sent;   ///< on the hand
  bool good = false;  ///< the result that was there could be sent
  double gain = 0.0;  ///< ForceGuard::gain()
  ForceGuard::Counts guard;
  double energy_Nmm = 0.0;             ///< put in by the hand and not got back (PassivityControl)
  double lowest_energy_Nmm = 0.0;      ///< minimum of that
  std::int64_t damped = 0;             ///< periods in which the passivity control added damping
  std::int64_t damped_too_little = 0;  ///< of those, with less than was owed
};

/// Event of a step, plain data.
struct EventSnapshot {
  EventKind kind{};
  double time_s = 0.0;  ///< simulated, since the simulation was made
  double depth_mm = 0.0;
  double force_N = 0.0;
  int region = -1;  ///< of the mesh, -1 where it has no meaning
};

}  // namespace stylet
