// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace stylet {

/// Number of single-character insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`
/// (optimal string alignment distance), upper and lower case alike.
int edit_distance(std::string_view a, std::string_view b);

/// The known name a mistyped one was probably meant to be: the one at the smallest edit distance, the first of equals;
/// empty when even that one differs in more than a third of the longer one's characters (one is always allowed).
std::string nearest_name(std::string_view mistyped, std::span<const std::string> known);

}  // namespace stylet
