// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scenario/toml_document.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace stylet::detail {

/// Builds a scenario from a file and settings, and records the place from which each key came, for messages.
class ScenarioReader {
 public:
  explicit ScenarioReader(const std::filesystem::path& file);

  /// Reads the file.
  Result<> read_file();
  /// Reads a text that stands for the content of the file.
  Result<> read_text(const std::string& text);
  /// Applies one setting, as of `--set key=value`.
  Result<> apply_setting(const std::string& setting);
  /// The complete scenario, checked.
  Result<Scenario> finish() &&;

 private:
  Result<> take(const TomlItem& item, const std::string& where);
  Result<> set(const TomlItem& item, const std::string& where);
  Result<> take_setting(const std::vector<std::string>& path, const std::string& text, const std::string& where);
  Result<std::vector<std::string>> setting_path(const std::string& key, const std::string& where) const;
  void resolve_paths(bool current_folder_first);
  [[nodiscard]] std::string place(std::string path) const;

  std::filesystem::path file_;
  Scenario scenario_;
  std::map<std::string, std::string> places_;  ///< key or table → "demo.toml, line 7" or "--set …"
  std::vector<TomlItem> tissue_values_;        ///< all values given so far below [tissue.REGION]
};

}  // namespace stylet::detail
