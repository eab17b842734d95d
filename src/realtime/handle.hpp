// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"

#include <cmath>

namespace stylet {

/// Whether a sample of a device can be used at `now_s`: it is valid, not too old, and its numbers are a pose.
inline bool usable(const DeviceInput& input, double now_s, double late_after_s) {
  if (!input.valid || !(now_s - input.time_s <= late_after_s)) return false;
  double turn = 0.0;
  for (const double q : input.pose.rotation) turn += q * q;
  double sum = turn;
  for (const double x : input.pose.origin) sum += x;
  return std::isfinite(sum) && turn > 0.25 && turn < 4.0;
}

/// The pose of a sample, with a normalised quaternion.
inline Pose handle(const DeviceInput& input) {
  Pose p = pose(input.pose);
  p.rotation.normalize();
  return p;
}

}  // namespace stylet
