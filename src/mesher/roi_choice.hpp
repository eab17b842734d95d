// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/mesher.hpp"

namespace stylet::meshing {

struct RoiChoice {
  const Roi* roi;
  std::string region;  ///< canonical name
};

/// Which ROIs of the set are meshed, and as what (choose_structures()), by priority. Notes what is left out.
/// Errors: those of choose_structures(), no target.
Result<std::vector<RoiChoice>> choose_rois(const ContourSet& set, const MeshOptions& options,
                                           std::vector<std::string>& notes);

}  // namespace stylet::meshing
