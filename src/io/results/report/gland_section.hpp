// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/recording_io.hpp"

#include <string>

namespace stylet::results {

/// The part of the report about the gland as a whole, as HTML: in words, as tables, and boxes that the page's scripts
/// fill with its path. Empty without a target.
std::string gland_section(const RunRecording& run);

/// A shift in anatomical words, "0.21 mm superior and 0.03 mm anterior". @param shift_mm LPS
std::string anatomical(const Vec3& shift_mm);

}  // namespace stylet::results
