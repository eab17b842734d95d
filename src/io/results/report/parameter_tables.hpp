// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <span>
#include <string>

namespace stylet::results {

/// The parameters of a run as HTML tables: tissue properties with one line per region and one column per key, then all
/// other parameters with one line each. The names are keys of the scenario, so that a reader can look them up and
/// change them.
std::string parameter_tables(std::span<const ParameterRow> parameters);

}  // namespace stylet::results
