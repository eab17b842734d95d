// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/sim/scenario.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stylet::detail {

/// A table or a value of a TOML document.
struct TomlItem {
  enum class Kind {
    table,
    value,
    unusable,  ///< a value no key takes: a date, a list of lists, …
  };
  Kind kind = Kind::value;
  std::vector<std::string> path;  ///< keys from the root; the entry of a list of tables is "[0]", "[1]", …
  ScenarioValue value;            ///< of Kind::value
  std::string what;               ///< of Kind::unusable, in words: "a date"
  std::size_t line = 0;           ///< from 1
  std::size_t column = 0;         ///< from 1
};

/// All tables and values of a document in the order of their appearance; a table comes before what is in it. Syntax
/// errors name line and column and quote the line.
/// @param source file name for the messages
Result<std::vector<TomlItem>> parse_toml(std::string_view text, const std::string& source);

/// "insertion[0].hole" of {"insertion", "[0]", "hole"}.
std::string joined(const std::vector<std::string>& path);

}  // namespace stylet::detail
