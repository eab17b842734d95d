// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stylet {

/// Positions of the names that a user's word means: those equal to it; where there is none, those that differ from it
/// in upper and lower case or in blanks around them only. A word of blanks, or none at all, means nothing.
std::vector<std::size_t> find_named(std::span<const std::string> names, std::string_view word);

/// Whether one of the words means this name, upper and lower case alike. No word means a name of blanks.
bool is_listed(std::string_view name, std::span<const std::string> words);

/// For the end of a cure, where a structure cannot be used: how to do without it.
std::string or_skip(std::string_view name);

}  // namespace stylet
