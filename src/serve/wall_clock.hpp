// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>

namespace stylet::serve {

/// Wall-clock time [s] since a fixed moment.
inline double wall_clock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace stylet::serve
