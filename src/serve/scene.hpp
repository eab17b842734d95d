// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene_points.hpp"
#include "stylet/serve/picture.hpp"
#include "stylet/sim/model.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stylet::serve {

/// A scene and where its points are in the mesh.
struct MadeScene {
  std::shared_ptr<const Scene> scene;
  ScenePoints points;  ///< (n)
};

/// Which cases can be opened.
struct CaseList {
  std::vector<std::string> titles;
  std::size_t open = 0;
  double dt_ms = 1.0;  ///< of the loop that runs them
};

/// All surfaces between regions and around the patient, each once, and what a page has to know about the case.
/// @param targets indices of the target regions
/// @param way of the needle, along which surfaces are drawn finer than the mesh has them; null: nowhere
MadeScene make_scene(const TetMesh& mesh, const std::vector<int>& targets, const Scenario& scenario,
                     const std::vector<PlannedInsertion>& insertions, const std::vector<std::string>& warnings,
                     const CaseList& cases, const PlannedInsertion* way);

}  // namespace stylet::serve
