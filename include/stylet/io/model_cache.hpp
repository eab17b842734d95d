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

/// The key under which the compiled model of a scenario is kept: SHA-256, in hexadecimal, of the build id of the
/// program or shared library that holds this code, the scenario with all its settings, and the content of every file
/// that it names. Another version, another value or another patient is another key; a stripped copy of the program is
/// the same program.
/// @param scenario as of read_scenario(), with absolute paths
/// Errors: a file that cannot be read; one whose data are in other files that it names (.mhd, .nhdr, .node and .ele),
/// which the key would not see; a program that was linked without a build id.
Result<std::string> model_key(const Scenario& scenario);

/// Compiled models kept from one start of the program to the next: files as `stylet prepare` writes them, named by
/// model_key(). Any number of programs may use a folder at the same time.
class ModelCache {
 public:
  /// @param folder where models are kept; made when the first one is. Empty: none are.
  /// @param others folders that are looked into as well
  /// @param most_bytes of all models in the folder: beyond it those go that were not used for longest
  explicit ModelCache(std::filesystem::path folder, std::vector<std::filesystem::path> others = {},
                      std::uintmax_t most_bytes = std::uintmax_t{4} << 30);

  /// $XDG_CACHE_HOME/stylet/models, else ~/.cache/stylet/models; empty without a home.
  static std::filesystem::path users_folder();

  /// The model's file; it counts as used now.
  [[nodiscard]] std::optional<std::filesystem::path> find(const std::string& key) const;

  /// Keeps a model that has just been compiled, and forgets the oldest others where there are too many. One that is
  /// larger than the folder may be, or that cannot be saved (save_model()), is not kept.
  /// @param notes of the mesher
  /// Errors: the disk's.
  Result<> keep(const Model& model, const std::string& key, std::span<const std::string> notes = {},
                const Progress& progress = {}) const;

 private:
  void forget_oldest(const std::filesystem::path& newest) const;

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> others_;
  std::uintmax_t most_bytes_;
};

}  // namespace stylet
