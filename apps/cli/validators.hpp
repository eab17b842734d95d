// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace stylet::cli {

/// Accepts a number from `lo` to `hi`; the error names the value and the range.
/// @param unit unit after the range in the error, e.g. "mm"; may be empty
CLI::Validator number_between(double lo, double hi, const std::string& unit = {});

/// Accepts a whole number from `lo` to `hi`.
CLI::Validator whole_number_between(long long lo, long long hi);

/// Accepts one of these words; the error names all of them and the nearest.
CLI::Validator one_of(std::vector<std::string> words);

/// Adds the option --volume, which chooses one volume of a mask file with several.
void add_volume_option(CLI::App& app, int& volume);

/// Adds the option --regions-from, which chooses the array of a mesh file that is its regions.
void add_regions_from_option(CLI::App& app, std::string& name);

}  // namespace stylet::cli
