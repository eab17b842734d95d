// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stylet {

/// Whether a needle in a region of this name harms the patient: true for rectum, bladder and urethra.
/// @param region canonical name
bool harmed_by_needle(std::string_view region);

/// One sentence for each time the needle entered an organ that it harms, in the order of the events: "The needle
/// entered the rectum, at a depth of 63.1 mm."
std::vector<std::string> harms(std::span<const Event> events);

}  // namespace stylet
