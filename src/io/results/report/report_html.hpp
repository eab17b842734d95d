// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pictures/pictures.hpp"
#include "report/moments.hpp"
#include "stylet/core/result.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/io/region_views.hpp"
#include "stylet/probe/patient_probe.hpp"
#include "stylet/sim/hole_map.hpp"

#include <span>
#include <string>

namespace stylet::results {

/// The complete report.html: text, pictures, data, style and script in one page that loads nothing from elsewhere.
/// @param run must have a summary and at least one frame
/// @param pictures from draw_pictures()
/// @param map of the template's holes; null if there is none
/// @param probe what the ultrasound probe does; null if there is none
Result<std::string> report_html(const RunRecording& run, std::span<const RegionView> regions, const Moments& moments,
                                const Pictures& pictures, const HoleMap* map = nullptr,
                                const ProbeReport* probe = nullptr);

}  // namespace stylet::results
