// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include <string>
#include <vector>

namespace stylet::cli {

/// The work whose time is told before it begins.
enum class Work { preparation, all };

/// Prints, before anything is meshed or computed, the warnings that a scenario file deserves (warnings_before_start())
/// and, with the first progress that the console shows, an estimate of time and memory; with less free memory than
/// that, a warning. Prints nothing for saved models, recordings and files that cannot be read, whose error comes from
/// their reader.
/// @param settings keys of the scenario to change, as "KEY=VALUE"
void warn_before_start(const std::string& file, const std::vector<std::string>& settings, Work work, Console& console);

}  // namespace stylet::cli
