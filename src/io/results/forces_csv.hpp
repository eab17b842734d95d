// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <span>
#include <string>

namespace stylet::results {

/// The text of forces.csv: the header and one line per step. Columns and units: docs/results.md. Number formats are
/// fixed and independent of the locale, so that the same steps give the same bytes.
std::string forces_csv(std::span<const Step> steps);

}  // namespace stylet::results
