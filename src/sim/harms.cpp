// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/harms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace stylet {

bool harmed_by_needle(std::string_view region) {
  constexpr std::array<std::string_view, 3> spared{"rectum", "bladder", "urethra"};
  return std::find(spared.begin(), spared.end(), region) != spared.end();
}

std::vector<std::string> harms(std::span<const Event> events) {
  std::vector<std::string> sentences;
  for (const Event& event : events) {
    if (event.kind == EventKind::region_entered && harmed_by_needle(event.region))
      sentences.push_back(
          fmt::format("The needle entered the {}, at a depth of {:.1f} mm.", event.region, event.depth_mm));
  }
  return sentences;
}

}  // namespace stylet
