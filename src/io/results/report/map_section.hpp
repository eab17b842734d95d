// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/hole_map.hpp"

#include <string>

namespace stylet::results {

/// The map of the template's holes: what it says, places for its pictures, and its table.
std::string map_section(const HoleMap& map);

}  // namespace stylet::results
