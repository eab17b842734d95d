// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/moments.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/io/region_views.hpp"
#include "stylet/sim/hole_map.hpp"

#include <span>
#include <string>

namespace stylet::results {

/// What the report's scripts draw, as JSON; web/report/src/data.ts describes every field. Numbers come as base64 of
/// little-endian arrays. Only surface nodes are kept, displacements as 16-bit integers with one common scale; steps and
/// frames are thinned where there are too many for a page of some 15 MB.
/// @param run has at least one frame and a summary
/// @param map of the template's holes; null where there is none
std::string report_data(const RunRecording& run, std::span<const RegionView> regions, const Moments& moments,
                        const HoleMap* map = nullptr);

}  // namespace stylet::results
