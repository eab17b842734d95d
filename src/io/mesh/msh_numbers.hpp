// SPDX-License-Identifier: GPL-3.0-or-later
// Detects elements that share a number in a gmsh file. In MSH 1 and 2 the gmsh library silently keeps only one of them.
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <functional>
#include <vector>

namespace stylet::detail {

/// Error if two elements of any kind have the same number, or if an MSH 1 or 2 file announces more elements than the
/// library has read.
/// @param taken numbers of all elements that the library has read
/// @param nodes_of function that gives the number of nodes of a gmsh element type
Result<> check_element_numbers(const std::filesystem::path& path, std::vector<std::size_t> taken,
                               const std::function<int(int type)>& nodes_of);

}  // namespace stylet::detail
