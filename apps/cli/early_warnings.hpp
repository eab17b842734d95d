// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include <string>
#include <vector>

namespace stylet::cli {

/// Prints the warnings that a scenario file deserves before anything is meshed or computed (warnings_before_start()).
/// Prints nothing for saved models, recordings and files that cannot be read, whose error comes from their reader.
/// @param settings keys of the scenario to change, as "KEY=VALUE"
void warn_before_start(const std::string& file, const std::vector<std::string>& settings, Console& console);

}  // namespace stylet::cli
