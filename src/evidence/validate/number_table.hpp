// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stylet::validate {

/// Columns of a CSV file of numbers, all equally long; lines with a field that is no finite number are left out.
/// @param names columns wanted, by the names in the first line; empty: a file without a header, all columns
/// Errors: input, when a column is not there or no line has numbers in all of them.
Result<std::vector<std::vector<double>>> read_number_table(const std::filesystem::path& file,
                                                           const std::vector<std::string>& names = {});

/// Value at x of the straight pieces between points; x outside takes the nearest end.
/// @param xs increasing, as long as ys, at least one
double interpolated(const std::vector<double>& xs, const std::vector<double>& ys, double x);

}  // namespace stylet::validate
