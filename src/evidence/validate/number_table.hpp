// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stylet::validate {

/// Reads columns of numbers, all of equal length, from a CSV file. Lines in which a wanted field is no finite number
/// are left out.
/// @param names wanted columns, by their names in the first line; empty: the file has no header and all columns are
/// read Errors: input, when a column is missing or no line has numbers in all columns.
Result<std::vector<std::vector<double>>> read_number_table(const std::filesystem::path& file,
                                                           const std::vector<std::string>& names = {});

/// Linear interpolation at x; outside the points, the value of the nearest end.
/// @param xs increasing abscissae, as many as ys, at least one
double interpolated(const std::vector<double>& xs, const std::vector<double>& ys, double x);

}  // namespace stylet::validate
