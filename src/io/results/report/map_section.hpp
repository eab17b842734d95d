// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/hole_map.hpp"

#include <string>

namespace stylet::results {

/// HTML of the report's section about the map of the template's holes: sentences, boxes for its pictures, and its
/// table.
std::string map_section(const HoleMap& map);

}  // namespace stylet::results
