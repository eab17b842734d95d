// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "reading/task.hpp"
#include "stylet/core/result.hpp"
#include "stylet/sim/scenario.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stylet {

void fields(auto& wire, ScenarioValue& v) { wire(v.type, v.number, v.boolean, v.text, v.numbers, v.texts); }

}  // namespace stylet

namespace stylet::detail {

/// A table or a value of a TOML document.
struct TomlItem {
  enum class Kind {
    table,
    value,
    unusable,  ///< a value of a type that no key has: a date, a list of lists, …
  };
  Kind kind = Kind::value;
  std::vector<std::string> path;  ///< keys from the root; an entry of a list of tables is "[0]", "[1]", …
  ScenarioValue value;            ///< for Kind::value
  std::string what;               ///< for Kind::unusable, the type in words: "a date"
  std::size_t line = 0;           ///< from 1
  std::size_t column = 0;         ///< from 1
};

/// Parses a document into its tables and values in the order of their appearance; a table comes before its content.
/// Syntax errors name line and column and quote the line.
/// @param source file name for messages
Result<std::vector<TomlItem>> parse_toml(std::string_view text, const std::string& source);

/// The same in the reading program, for a text that precheck_toml() lets pass; its argument is the text.
inline constexpr Task<std::vector<TomlItem>, std::string> kToml{"parse_toml_text"};
Result<std::vector<TomlItem>> parse_toml_text(std::string_view text, const std::string& source);

void fields(auto& wire, TomlItem& i) { wire(i.kind, i.path, i.value, i.what, i.line, i.column); }

/// Joins a path: {"insertion", "[0]", "hole"} → "insertion[0].hole".
std::string joined(const std::vector<std::string>& path);

}  // namespace stylet::detail
