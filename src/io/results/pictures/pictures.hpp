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

/// The still pictures of a run: bytes of a PNG file under each name of picture_names(), or none and the reason.
struct Pictures {
  std::map<std::string, std::string> png;
  std::string why_not;  ///< empty when all pictures were drawn
  bool wanted = true;   ///< false: the scenario asks for none
};

/// For the moments before, deepest and after view_MOMENT.png, sagittal_MOMENT.png and transverse_MOMENT.png;
/// sagittal_displacement.png and transverse_displacement.png for the deepest.
std::span<const char* const> picture_names();

/// Draws all pictures, in child processes with limits, since an OpenGL driver can take its process down: whatever
/// happens there, this call returns.
/// @param run has at least one frame
Pictures draw_pictures(const RunRecording& run, std::span<const RegionView> regions, const Moments& moments,
                       const Progress& progress);

}  // namespace stylet::results
