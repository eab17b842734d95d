// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <string>
#include <string_view>

namespace stylet::detail {

/// Checks a text for the most common errors that the TOML parser cannot handle, and gives a clear message. toml++ 3.3
/// (Debian 12) violates its own preconditions, with undefined behaviour or a failed assertion, for a non-ASCII
/// character, such as an editor's curly quotation mark, outside of quotes or after a continued line; for a table header
/// that does not begin with a name; and for several malformed values (github.com/marzer/tomlplusplus issues 190 and
/// 294, pull request 301). Errors that this check does not find can only crash the reading program.
/// @param source file name for the message
Result<> precheck_toml(std::string_view text, const std::string& source);

/// Whether a text is valid UTF-8 without control characters and line ends.
bool is_readable(std::string_view text);

}  // namespace stylet::detail
