// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <span>
#include <string>
#include <string_view>

namespace stylet::results {

/// The header line of forces.csv, without line end. Columns and units: docs/results.md.
std::string_view forces_csv_header();

/// The text of forces.csv: the header and one line per step. Number formats are fixed and independent of the locale, so
/// that the same steps give the same bytes. A value that is not finite prints as "nan" or "inf".
std::string forces_csv(std::span<const Step> steps);

}  // namespace stylet::results
