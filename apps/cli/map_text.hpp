// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/hole_map.hpp"

#include <string>

namespace stylet::cli {

/// The text that `stylet insert --map` prints: a table with a line for each hole, an explanation of the numbers, and
/// remarks on single holes. Without the last line end.
std::string map_text(const HoleMap& map);

}  // namespace stylet::cli
