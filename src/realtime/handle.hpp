// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"

#include <cmath>

namespace stylet {

/// Whether a sample of a device can be used at `now_s`: valid, not too old, numbers that are a pose.
inline bool usable(const DeviceInput& input, double now_s, double late_after_s) {
  if (!input.valid || !(now_s - input.time_s <= late_after_s)) return false;
  double turn = 0.0;
  for (const double q : input.pose.rotation) turn += q * q;
  double sum = turn;
  for (const double x : input.pose.origin) sum += x;
  return std::isfinite(sum) && turn > 0.25 && turn < 4.0;
}

/// Its pose, with a rotation of length 1.
inline Pose handle(const DeviceInput& input) {
  Pose p = pose(input.pose);
  p.rotation.normalize();
  return p;
}

}  // namespace stylet
