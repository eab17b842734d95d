// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/implant/needle_load.hpp"
#include "stylet/io/model_cache.hpp"
#include "stylet/sim/model.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stylet {

/// A compiled model, with notes and times of its preparation.
struct PreparedModel {
  std::shared_ptr<const Model> model;
  std::vector<std::string> notes;  ///< sentences for the user: what reader or mesher left out, added or corrected
  std::string not_kept;            ///< why the cache could not store the model; empty if it did or if there is no cache
  double mesh_s = 0.0;             ///< time to read and mesh the patient
  double model_s = 0.0;            ///< time to compile the model, or to load a saved model

  /// All messages for the user before the first step: the notes, then the model's warnings.
  [[nodiscard]] std::vector<std::string> warnings() const;
};

/// Meshes the patient of a scenario and compiles the model. This takes seconds to minutes.
/// @param scenario paths in it are relative to the current folder
/// @param where name of the scenario in error messages
/// Errors: those of mesh_patient(), of reading a recorded motion, and of Model::compile().
Result<PreparedModel> prepare_model(const Scenario& scenario, const Progress& progress = {},
                                    const std::string& where = "scenario");

/// Prepares the model of a scenario file, or loads a model that was saved with save_model().
/// @param file SCENARIO.toml or MODEL.stylet
/// @param settings keys of the scenario to change, as "KEY=VALUE"
/// @param cache is searched for the model of an unchanged scenario, and keeps a new model; may be null. A folder that
///   cannot be written is not an error (PreparedModel::not_kept).
Result<PreparedModel> prepare_model_file(const std::string& file, const std::vector<std::string>& settings = {},
                                         const Progress& progress = {}, const ModelCache* cache = nullptr);

/// Prepares the model of a scenario file for the first needle of its plan of seeds, which stands in for the insertion
/// that such a scenario does not have.
/// @param first the first needle of the plan
/// Errors: those of prepare_model() and of needle_insertion().
Result<PreparedModel> prepare_needle_of_file(const std::string& file, const std::vector<std::string>& settings,
                                             const NeedleLoad& first, const Progress& progress = {},
                                             const ModelCache* cache = nullptr);

}  // namespace stylet
