// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/recording_io.hpp"

#include <string>

namespace stylet::results {

/// HTML of the report's section about the gland's motion: sentences, tables, and boxes in which the page's scripts draw
/// its path. Empty without a target.
std::string gland_section(const RunRecording& run);

/// A shift in anatomical terms: "0.21 mm superior and 0.03 mm anterior". @param shift_mm LPS
std::string anatomical(const Vec3& shift_mm);

}  // namespace stylet::results
