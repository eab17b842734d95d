// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace stylet::detail {

/// An object of a JSON file, whose values are read with messages that name file and key.
class JsonObject {
 public:
  JsonObject(const nlohmann::json& json, std::string where) : json_(&json), where_(std::move(where)) {}

  /// Errors: not an object; a key that is not among `known`, with the nearest known name.
  [[nodiscard]] Result<> check_keys(std::span<const std::string> known) const;

  [[nodiscard]] bool has(const std::string& key) const { return json_->contains(key) && !(*json_)[key].is_null(); }
  [[nodiscard]] const nlohmann::json& at(const std::string& key) const { return (*json_)[key]; }
  [[nodiscard]] std::string place(const std::string& key) const { return where_ + ", '" + key + "'"; }
  [[nodiscard]] const std::string& where() const { return where_; }

  /// Sets `value` if the object has the key. Error: the value is not text, or not a finite number, or not three of
  /// them.
  [[nodiscard]] Result<> take(const std::string& key, std::string& value) const;
  [[nodiscard]] Result<> take(const std::string& key, double& value) const;
  [[nodiscard]] Result<> take(const std::string& key, Vec3& value) const;
  [[nodiscard]] Result<> take(const std::string& key, std::vector<double>& values) const;

 private:
  const nlohmann::json* json_;
  std::string where_;
};

/// Reads a JSON file whose "format" and "version" have these values. Errors: not JSON, with line and column; another
/// format or version.
Result<nlohmann::json> read_json(const std::filesystem::path& path, const char* format, int version);

}  // namespace stylet::detail
