// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "record/implant_columns.hpp"
#include "stylet/io/implant_results.hpp"

#include <string>

/// Seeds as seeds.csv, found.csv and summary.json show them.
namespace stylet::results {

SeedRow row_of_seed(const SeedHistory& seed, const ImplantOutcome& outcome);

/// @param matched the seed that was found for it; null: none was
FoundRow row_of_found(const SeedHistory& seed, const MatchedSeed* matched, const ImplantHistory& history,
                      const FoundComparison& comparison);

/// A length [mm] as the tables of seeds have it, whatever digits a field says.
std::string four_decimals(double value, int decimals);

}  // namespace stylet::results
