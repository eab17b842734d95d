// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stylet::meshing {

/// The words of a name in lower case. "Transition_Zone", "transition zone" and "TransitionZone" have the same two
/// words.
std::vector<std::string> words_of(std::string_view name);

}  // namespace stylet::meshing
