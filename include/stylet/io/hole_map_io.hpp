// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/hole_map.hpp"

#include <string>

namespace stylet {

/// A map of the template's holes as map.csv has it (docs/results.md): one header line, then one line per hole.
std::string hole_map_csv(const HoleMap& map);

/// The same as JSON, with the template it is of (docs/results.md). What does not exist is null.
std::string hole_map_json(const HoleMap& map);

}  // namespace stylet
