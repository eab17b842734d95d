// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/sim/model.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// The key of a scenario's compiled model in the cache: SHA-256, in hexadecimal, of the build id of the program or
/// shared library that holds this code, the scenario with all its settings, and the content of every file that it
/// names. Any other version, value or patient gives another key; a stripped copy of the program gives the same key.
/// @param scenario from read_scenario(), with absolute paths
/// Errors: a file that cannot be read; a file whose data are in other files (.mhd, .nhdr, .node and .ele), which the
/// key would not cover; a program that was linked without a build id.
Result<std::string> model_key(const Scenario& scenario);

/// A folder with compiled models for later starts of the program: files as `stylet prepare` writes them, named by
/// model_key(). Any number of programs may use the folder at the same time.
class ModelCache {
 public:
  /// @param folder for the models; it is created with the first one. Empty: no model is kept.
  /// @param others further folders to search, in which nothing is written
  /// @param most_bytes largest total size of the models in `folder`; the least recently used models are removed
  explicit ModelCache(std::filesystem::path folder, std::vector<std::filesystem::path> others = {},
                      std::uintmax_t most_bytes = std::uintmax_t{4} << 30);

  /// The user's cache folder: $XDG_CACHE_HOME/stylet/models, else ~/.cache/stylet/models; empty without a home folder.
  static std::filesystem::path users_folder();

  /// The file of a model, if there is one; it then counts as used at this moment.
  [[nodiscard]] std::optional<std::filesystem::path> find(const std::string& key) const;

  /// Saves a model that has just been compiled, and removes the least recently used other models if the folder is too
  /// large. A model that exceeds the folder's limit or that save_model() does not support is not kept.
  /// @param notes notes of the mesher
  /// Errors: of the disk.
  Result<> keep(const Model& model, const std::string& key, std::span<const std::string> notes = {},
                const Progress& progress = {}) const;

 private:
  void forget_oldest(const std::filesystem::path& newest) const;

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> others_;
  std::uintmax_t most_bytes_;
};

}  // namespace stylet
