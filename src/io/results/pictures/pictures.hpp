// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/moments.hpp"
#include "stylet/core/progress.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/io/region_views.hpp"

#include <map>
#include <span>
#include <string>

namespace stylet::results {

/// The still pictures of a run: the bytes of a PNG file for each name of picture_names(), or none and the reason.
struct Pictures {
  std::map<std::string, std::string> png;
  std::string why_not;  ///< reason why there are no pictures; empty if all were drawn
  bool wanted = true;   ///< false: the scenario does not want pictures
};

/// File names of the pictures: view_MOMENT.png, sagittal_MOMENT.png and transverse_MOMENT.png for the moments before,
/// deepest and after; sagittal_displacement.png and transverse_displacement.png for the deepest.
std::span<const char* const> picture_names();

/// Draws all pictures. This is done in child processes with limits, because an OpenGL driver can crash its process;
/// this call returns in any case.
/// @param run has at least one frame
Pictures draw_pictures(const RunRecording& run, std::span<const RegionView> regions, const Moments& moments,
                       const Progress& progress);

}  // namespace stylet::results
