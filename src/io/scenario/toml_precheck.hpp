// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <string>
#include <string_view>

namespace stylet::detail {

/// Refuses what the TOML parser must not see. toml++ 3.3 (Debian 12) breaks its own preconditions, with undefined
/// behaviour or a failed assertion, where a character beyond ASCII stands outside of quotes or after a continued line,
/// where a table's header does not begin with a name, and where a list is closed by a brace
/// (github.com/marzer/tomlplusplus issues 190 and 294, pull request 301). None of these is TOML but the continued line;
/// and the first, say an editor's curly quotation marks, deserves a better message anyway.
/// @param source file name for the message
Result<> precheck_toml(std::string_view text, const std::string& source);

}  // namespace stylet::detail
