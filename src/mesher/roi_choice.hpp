// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/mesher.hpp"

namespace stylet::meshing {

/// A ROI to be meshed.
struct RoiChoice {
  const Roi* roi;
  std::string region;  ///< canonical name
};

/// The ROIs of the set that are meshed, with their regions, sorted by priority (choose_structures()). Adds notes about
/// ROIs that are left out. Errors: those of choose_structures(), and an input without a target.
Result<std::vector<RoiChoice>> choose_rois(const ContourSet& set, const MeshOptions& options,
                                           std::vector<std::string>& notes);

}  // namespace stylet::meshing
