// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string_view>

namespace stylet {

/// Callback of long computations: receives the name of the current stage and the fraction of it that is done, 0…1. May
/// be empty.
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// Calls `progress` unless it is empty.
inline void report(const Progress& progress, std::string_view stage, double fraction) {
  if (progress) progress(stage, fraction);
}

}  // namespace stylet
