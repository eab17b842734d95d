// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/fem/tissue.hpp"
#include "stylet/geom/locator.hpp"
#include "stylet/sim/scenario.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stylet {

/// A patient's tissue with the materials, supports and elements that a model has, without what only a needle needs: no
/// path is compiled.
struct HeldTissue {
  std::shared_ptr<const Tissue> tissue;
  std::shared_ptr<const Topology> topology;
  std::shared_ptr<const Locator> locator;
  std::vector<int> target;  ///< regions that form the target, the gland
};

/// Holds and factorises the tissue of a scenario, which takes seconds to minutes. As in a model, outer faces near the
/// entries of the scenario's insertions stay free where outer faces are held; an insertion that cannot be planned, or
/// that follows a recorded motion, has no entry here.
/// @param where name of the patient in messages
/// Errors: nothing holds the tissue, or not all of it.
Result<HeldTissue> hold_tissue(const Scenario& scenario, TetMesh mesh, const std::string& where,
                               const Progress& progress = {});

}  // namespace stylet
