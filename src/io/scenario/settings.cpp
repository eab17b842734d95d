// SPDX-License-Identifier: GPL-3.0-or-later
// Applies settings of the command line: --set key=value.
#include "detail/text.hpp"
#include "scenario/scenario_reader.hpp"
#include "scenario/toml_precheck.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

namespace stylet::detail {

namespace {

constexpr const char* kForm =
    "Write --set key=value, for example --set insertion[0].depth_mm=60 or --set tissue.prostate.young_kPa=30";

/// Position of the first `wanted` outside of quotation marks.
std::size_t find_unquoted(std::string_view text, char wanted, std::size_t from = 0) {
  char quote = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    if (quote == 0 && text[i] == wanted) return i;
    if (quote != 0 ? text[i] == quote : (text[i] == '"' || text[i] == '\'')) quote = quote != 0 ? '\0' : text[i];
  }
  return std::string_view::npos;
}

std::string unquoted(std::string text) {
  if (text.size() > 1 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front()) {
    return text.substr(1, text.size() - 2);
  }
  return text;
}

/// Splits a path: "insertion[0].hole" → {"insertion", "[0]", "hole"}. Names in quotation marks may contain dots.
std::vector<std::string> parts_of(const std::string& key) {
  std::vector<std::string> parts;
  for (std::size_t start = 0;;) {
    const auto dot = find_unquoted(key, '.', start);
    std::string part = unquoted(trimmed(std::string_view(key).substr(start, dot - start)));
    const auto bracket = part.find('[');
    const bool may_be_list = start == 0 || (parts.size() == 1 && parts.front() == "plan");
    if (may_be_list && bracket != std::string::npos && bracket > 0 && part.back() == ']') {
      parts.push_back(part.substr(0, bracket));
      part = part.substr(bracket);
    }
    parts.push_back(std::move(part));
    if (dot == std::string::npos) return parts;
    start = dot + 1;
  }
}

/// Parses a text as a TOML value; empty if it is not a single TOML value.
std::optional<std::vector<TomlItem>> as_toml(const std::string& text) {
  auto items = parse_toml("value = " + text, "");
  if (!items) return std::nullopt;
  for (const TomlItem& item : *items) {
    if (item.path.front() != "value") return std::nullopt;
  }
  return std::move(*items);
}

}  // namespace

/// The path of a setting. The number of the insertion, which may be omitted if there is only one, is filled in.
Result<std::vector<std::string>> ScenarioReader::setting_path(const std::string& key, const std::string& where) const {
  std::vector<std::string> path = parts_of(key);
  if (path.front() != "insertion") return path;
  const std::size_t count = scenario_.insertions.size();
  if (path.size() > 1 && path[1].starts_with("[")) {
    std::size_t number = 0;
    const char* digits = path[1].data() + 1;
    const char* end = path[1].data() + path[1].size() - 1;
    const auto [stop, status] = std::from_chars(digits, end, number);
    if (status != std::errc{} || stop != end || number > count) {
      return input_error(where, fmt::format("there is no insertion{}: the scenario has {}", path[1], count),
                         count == 0
                             ? "Write insertion[0] for the first"
                             : fmt::format("Write insertion[0] for the first; insertion[{}] adds another", count));
    }
    return path;
  }
  if (count > 1) {
    return input_error(where, fmt::format("the scenario has {} insertions, and the setting does not say which", count),
                       fmt::format("Write insertion[0]{0} to insertion[{1}]{0}",
                                   key.substr(std::string("insertion").size()), count - 1));
  }
  path.insert(path.begin() + 1, "[0]");
  return path;
}

Result<> ScenarioReader::take_setting(const std::vector<std::string>& path, const std::string& text,
                                      const std::string& where) {
  const auto take_text = [&] {
    TomlItem item;
    item.path = path;
    item.value = {.type = ScenarioValue::Type::text, .text = text};
    return take(item, where);
  };
  auto items = as_toml(text);
  if (!items) return take_text();
  for (TomlItem& item : *items) {
    item.path.erase(item.path.begin());
    item.path.insert(item.path.begin(), path.begin(), path.end());
    Result<> taken = take(item, where);
    if (taken) continue;
    // A shell removes quotation marks, so --set name=2024 may mean a text.
    const bool was_text = item.kind == TomlItem::Kind::value && item.value.type == ScenarioValue::Type::text;
    if (was_text || items->size() > 1 || !take_text()) return taken;
  }
  return Ok{};
}

Result<> ScenarioReader::apply_setting(const std::string& setting) {
  if (!is_readable(setting)) {
    std::string readable = setting;
    for (char& c : readable) {
      if (c < 0x20 || c > 0x7e) c = '?';
    }
    return input_error("--set " + readable, "the setting has characters that are not printable text (UTF-8)", kForm);
  }
  const std::string where = "--set " + setting;
  const auto equals = find_unquoted(setting, '=');
  if (equals == std::string::npos) return input_error(where, "there is no '=' in it", kForm);
  const std::string key = trimmed(std::string_view(setting).substr(0, equals));
  if (key.empty()) return input_error(where, "there is no key before the '='", kForm);
  const auto path = setting_path(key, where);
  if (!path) return path.error();
  const std::string value = trimmed(std::string_view(setting).substr(equals + 1));
  if (Result<> taken = take_setting(*path, value, where); !taken) return taken;
  resolve_paths(true);
  return Ok{};
}

}  // namespace stylet::detail
