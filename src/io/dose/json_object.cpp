// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/json_object.hpp"

#include "detail/input_file.hpp"
#include "detail/json_text.hpp"
#include "stylet/core/json_text.hpp"
#include "stylet/core/nearest_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace stylet::detail {

namespace {

constexpr std::size_t kLongestShown = 60;  // characters of a wrong value that a message shows

Error wrong_value(const std::string& place, const nlohmann::json& value, const char* expected) {
  const std::string shown = shortened(json_text(value), kLongestShown);
  return input_error(place, fmt::format("the value is {}, {} is expected", shown, expected), "Correct this value");
}

}  // namespace

Result<> JsonObject::check_keys(std::span<const std::string> known) const {
  if (!json_->is_object()) return wrong_value(where_, *json_, "an object in braces");
  for (const auto& [key, value] : json_->items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string near = nearest_name(key, known);
    return input_error(where_, fmt::format("the key '{}' is unknown", key),
                       near.empty() ? fmt::format("Use one of these keys: {}", fmt::join(known, ", "))
                                    : fmt::format("Did you mean '{}'?", near));
  }
  return Ok{};
}

Result<> JsonObject::take(const std::string& key, std::string& value) const {
  if (!has(key)) return Ok{};
  if (!at(key).is_string()) return wrong_value(place(key), at(key), "text in quotes");
  value = at(key).get<std::string>();
  return Ok{};
}

Result<> JsonObject::take(const std::string& key, double& value) const {
  if (!has(key)) return Ok{};
  if (!at(key).is_number() || !std::isfinite(at(key).get<double>()))
    return wrong_value(place(key), at(key), "a finite number");
  value = at(key).get<double>();
  return Ok{};
}

Result<> JsonObject::take(const std::string& key, Vec3& value) const {
  std::vector<double> numbers;
  if (!has(key)) return Ok{};
  if (Result<> taken = take(key, numbers); !taken) return taken;
  if (numbers.size() != 3) return wrong_value(place(key), at(key), "a list of three numbers");
  value = Vec3(numbers[0], numbers[1], numbers[2]);
  return Ok{};
}

Result<> JsonObject::take(const std::string& key, std::vector<double>& values) const {
  if (!has(key)) return Ok{};
  if (!at(key).is_array()) return wrong_value(place(key), at(key), "a list of numbers");
  values.clear();
  for (const nlohmann::json& number : at(key)) {
    if (!number.is_number() || !std::isfinite(number.get<double>()))
      return wrong_value(place(key), number, "a finite number");
    values.push_back(number.get<double>());
  }
  return Ok{};
}

Result<nlohmann::json> read_json(const std::filesystem::path& path, const char* format, int version) {
  const std::string file = path.string();
  if (Result<> readable = check_input_file(path); !readable) return readable.error();
  Result<nlohmann::json> parsed = parse_json_file(path);
  if (!parsed) return parsed;
  nlohmann::json& json = *parsed;
  if (!json.is_object() || !json.contains("format") || json["format"] != format) {
    return input_error(file, fmt::format("this JSON file does not say \"format\": \"{}\"", format),
                       "Name a file as docs/formats.md describes it");
  }
  if (!json.contains("version") || json["version"] != version) {
    return input_error(
        file,
        fmt::format("format version {} is unknown, {} is expected",
                    json.contains("version") ? shortened(json_text(json["version"]), 60) : "(none)", version),
        fmt::format("Write \"version\": {}, or use the Stylet that wrote the file", version));
  }
  return parsed;
}

}  // namespace stylet::detail
