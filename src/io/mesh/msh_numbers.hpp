// SPDX-License-Identifier: GPL-3.0-or-later
// Elements that share a number in a gmsh file. Of those in MSH 1 and 2 the library keeps one and does not say so.
#pragma once

#include "stylet/core/result.hpp"

#include <filesystem>
#include <functional>
#include <vector>

namespace stylet::detail {

/// Refuses a file in which two elements, of any kind, have the same number, and one of MSH 1 or 2 that announces more
/// elements than the library took.
/// @param taken numbers of all elements that the library took
/// @param nodes_of how many nodes an element of a gmsh type has
Result<> check_element_numbers(const std::filesystem::path& path, std::vector<std::size_t> taken,
                               const std::function<int(int type)>& nodes_of);

}  // namespace stylet::detail
