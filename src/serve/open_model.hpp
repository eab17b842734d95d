// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene_points.hpp"
#include "stylet/sim/display_field.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stylet::serve {

/// An open model and what is needed to show it.
struct OpenModel {
  std::shared_ptr<const Model> model;
  std::vector<std::string> notes;             ///< LoadedCase::notes
  std::shared_ptr<const DisplayField> field;  ///< empty until it is prepared
  ScenePoints points;                         ///< points of the scene
  std::size_t way = 0;  ///< index of the insertion along whose planned path the scene is drawn finer

  /// All warnings for the user: the notes, then the model's warnings.
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> all = notes;
    all.insert(all.end(), model->warnings().begin(), model->warnings().end());
    return all;
  }
};

}  // namespace stylet::serve
