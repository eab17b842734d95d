// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/moments.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/io/region_views.hpp"
#include "stylet/sim/hole_map.hpp"

#include <span>
#include <string>

namespace stylet::results {

/// The data for the report's scripts as JSON; web/report/src/data.ts describes every field. Numbers are base 64 of
/// little-endian arrays. Only surface nodes are included, with displacements as 16-bit integers with one common scale;
/// steps and frames are thinned out if they are too many for a page of about 15 MB.
/// @param run must have a summary and at least one frame
/// @param map of the template's holes; null if there is none
std::string report_data(const RunRecording& run, std::span<const RegionView> regions, const Moments& moments,
                        const HoleMap* map = nullptr);

}  // namespace stylet::results
