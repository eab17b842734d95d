// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/imaging_settings.hpp"

namespace stylet {

/// Where the stepper holds the probe in the rectum from a moment on.
struct ProbeMove {
  double time_s = 0;
  ProbeSettings probe;
};

}  // namespace stylet
