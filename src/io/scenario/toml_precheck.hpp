// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <string>
#include <string_view>

namespace stylet::detail {

/// Refuses with a good message the commonest of what the TOML parser cannot bear. toml++ 3.3 (Debian 12) breaks its own
/// preconditions, with undefined behaviour or a failed assertion, where a character beyond ASCII, say an editor's curly
/// quotation mark, stands outside of quotes or after a continued line, where a table's header does not begin with a
/// name, and in several malformed values (github.com/marzer/tomlplusplus issues 190 and 294, pull request 301). What
/// this check does not see ends in the child process that the parser runs in.
/// @param source file name for the message
Result<> precheck_toml(std::string_view text, const std::string& source);

/// Is it UTF-8 without control characters, line ends included?
bool is_readable(std::string_view text);

}  // namespace stylet::detail
