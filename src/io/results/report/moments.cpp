// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/moments.hpp"

#include <algorithm>

namespace stylet::results {

Moments find_moments(std::span<const Frame> frames) {
  const auto labelled = [&](const char* label, std::size_t otherwise) {
    const auto found = std::find_if(frames.begin(), frames.end(), [&](const Frame& f) { return f.label == label; });
    return found == frames.end() ? otherwise : static_cast<std::size_t>(found - frames.begin());
  };
  const auto deepest = std::max_element(
      frames.begin(), frames.end(), [](const Frame& a, const Frame& b) { return a.base_depth_mm < b.base_depth_mm; });
  return {labelled("before", 0), labelled("deepest", static_cast<std::size_t>(deepest - frames.begin())),
          labelled("after", frames.size() - 1)};
}

}  // namespace stylet::results
