// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/printable.hpp"

#include <string>

namespace stylet {

/// The text of JSON (nlohmann::json or ordered_json). It is the only way from JSON to text, because the library's own
/// throws for a name that is not UTF-8; scripts/check_lint refuses the library's. Numbers that are not finite become
/// null, and strings printable text (printable_json()).
/// @param indent [blanks] of each level; −1: everything in one line
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return printable_json(json.dump(indent, ' ', false, Json::error_handler_t::replace));
}

}  // namespace stylet
