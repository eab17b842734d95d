// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/gland_motion.hpp"

#include <span>
#include <string>

namespace stylet::results {

/// The text of gland.csv: a header and one line per step, as in forces.csv. Columns and units: docs/results.md. Number
/// formats are fixed and independent of the locale, so that the same path gives the same bytes.
std::string gland_csv(std::span<const GlandStep> path);

}  // namespace stylet::results
