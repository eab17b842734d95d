// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/mesher.hpp"

namespace stylet::meshing {

struct RoiChoice {
  const Roi* roi;
  std::string region;  ///< canonical name
};

/// Which ROIs of the set are meshed, and as what, by priority. With options.regions those; else every ROI whose name is
/// recognised, a planning volume only where the gland itself was not drawn. Notes what is passed over.
/// Errors: unknown or empty ROI asked for, no target.
Result<std::vector<RoiChoice>> choose_rois(const ContourSet& set, const MeshOptions& options,
                                           std::vector<std::string>& notes);

}  // namespace stylet::meshing
