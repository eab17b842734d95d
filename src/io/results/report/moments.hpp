// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <cstddef>
#include <span>

namespace stylet::results {

/// Indices of the three frames that represent a run in pictures and text.
struct Moments {
  std::size_t before = 0;   ///< the frame labelled "before", else the first
  std::size_t deepest = 0;  ///< the frame labelled "deepest", else the one with the largest base depth
  std::size_t after = 0;    ///< the frame labelled "after", else the last
};

/// @param frames at least one, in the order of time
Moments find_moments(std::span<const Frame> frames);

}  // namespace stylet::results
