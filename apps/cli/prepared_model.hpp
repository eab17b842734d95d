// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/io/model_cache.hpp"
#include "stylet/sim/model.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stylet::cli {

/// A model ready for its first step.
struct PreparedModel {
  std::shared_ptr<const Model> model;
  std::vector<std::string> notes;  ///< of the patient's file and the mesher: what was left out, added, put right
  std::string not_kept;            ///< why the cache has it not for the next time; empty: it has, or there is none
  double mesh_s = 0.0;             ///< contours, mask or file to mesh
  double model_s = 0.0;            ///< mesh to model, or a saved model to model

  /// All that a user should know before the first step: the notes, then the model's warnings.
  [[nodiscard]] std::vector<std::string> warnings() const;
};

/// The model of a scenario file, meshed and compiled, or of a saved model.
/// @param file SCENARIO.toml or MODEL.stylet
/// @param settings of --set
/// @param cache where the model of a scenario is looked for first, and kept; may be null. A folder that refuses is no
///   error.
Result<PreparedModel> prepared_model(const std::string& file, const std::vector<std::string>& settings,
                                     const Progress& progress, const ModelCache* cache = nullptr);

}  // namespace stylet::cli
