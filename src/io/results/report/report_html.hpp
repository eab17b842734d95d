// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pictures/pictures.hpp"
#include "report/moments.hpp"
#include "stylet/core/result.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/io/region_views.hpp"
#include "stylet/sim/hole_map.hpp"

#include <span>
#include <string>

namespace stylet::results {

/// The whole report.html: text, pictures, data, style and script in one page that loads nothing.
/// @param run has at least one frame and a summary
/// @param pictures what draw_pictures() returned
/// @param map of the template's holes; null where there is none
Result<std::string> report_html(const RunRecording& run, std::span<const RegionView> regions, const Moments& moments,
                                const Pictures& pictures, const HoleMap* map = nullptr);

}  // namespace stylet::results
