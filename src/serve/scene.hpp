// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene_points.hpp"
#include "stylet/serve/picture.hpp"
#include "stylet/sim/model.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace stylet::serve {

/// A scene and the place of each of its points in the mesh.
struct MadeScene {
  std::shared_ptr<const Scene> scene;
  ScenePoints points;  ///< (n)
};

/// The cases that can be opened.
struct CaseList {
  std::vector<std::string> titles;
  std::size_t open = 0;  ///< index of the open case
  double dt_ms = 1.0;    ///< period of the real-time loop
};

/// Centre of the template [mm] LPS x and y: from the scenario, else the target's centroid.
std::array<double, 2> template_centre(const TetMesh& mesh, const std::vector<int>& targets, const TemplateGrid& grid);

/// Makes the scene: all surfaces between regions and around the patient, each once, and the text that a page needs.
/// @param targets indices of the target regions
/// @param way planned path of the needle, along which surfaces are refined beyond the mesh; null: no refinement
MadeScene make_scene(const TetMesh& mesh, const std::vector<int>& targets, const Scenario& scenario,
                     const std::vector<PlannedInsertion>& insertions, const std::vector<std::string>& warnings,
                     const CaseList& cases, const PlannedInsertion* way);

}  // namespace stylet::serve
