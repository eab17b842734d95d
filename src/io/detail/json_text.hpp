// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

namespace stylet::detail {

/// Deepest nesting of lists and objects in a JSON text that is read. No format has more than a dozen; what walks
/// through a value calls itself for each level, and would run out of stack.
inline constexpr int kDeepestJson = 64;

/// Parses a JSON text of unknown origin. Errors: not JSON, with line and column; nested too deeply.
/// @param where place for messages, e.g. the name of the file
template <class Json = nlohmann::json>
Result<Json> parse_json(std::string_view text, const std::string& where) {
  struct TooDeep : std::runtime_error {
    using std::runtime_error::runtime_error;
  };
  try {
    return Json::parse(text, [](int depth, typename Json::parse_event_t, Json&) {
      if (depth > kDeepestJson) throw TooDeep("");
      return true;
    });
  } catch (const TooDeep&) {
    return input_error(where, fmt::format("lists and objects are nested more than {} deep", kDeepestJson),
                       "Give a file as docs/formats.md describes it");
  } catch (const typename Json::parse_error& error) {
    const std::string_view before = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const auto column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
    return input_error(
        where,
        fmt::format("not valid JSON: {} at line {}, column {}",
                    error.byte > text.size() ? "the text ends too early" : "something else is expected", line, column),
        "Correct the file at that place");
  } catch (const typename Json::exception&) {
    return input_error(where, "not valid JSON: a number is out of range", "Correct the file");
  }
}

/// The same for a whole file.
template <class Json = nlohmann::json>
Result<Json> parse_json_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return parse_json<Json>(text, path.string());
}

}  // namespace stylet::detail
