// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/hole_map.hpp"

#include <string>

namespace stylet {

/// The text of map.csv for a map of the template's holes (docs/results): one header line, then one line per hole.
std::string hole_map_csv(const HoleMap& map);

/// The map as JSON, together with its template (docs/results). Values that do not exist are null.
std::string hole_map_json(const HoleMap& map);

}  // namespace stylet
