// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace stylet {

/// Edit distance (optimal string alignment): the number of insertions, deletions and substitutions of one character and
/// swaps of two neighbouring characters that turn `a` into `b`. Upper and lower case count as equal.
int edit_distance(std::string_view a, std::string_view b);

/// The known name that a mistyped or incomplete name most probably stands for.
/// @return the name in `known` with the smallest edit distance, the first one among equals. When this distance is more
///   than a third of the length of the longer name (a distance of one is always accepted), the name that shares most
///   words with the mistyped one, so that "speed" finds "speed_mm_per_s"; empty when no name shares a word
std::string nearest_name(std::string_view mistyped, std::span<const std::string> known);

}  // namespace stylet
