// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stylet::serve {

/// The value of the header Content-Disposition with which a browser saves a file under this name (RFC 6266): the name
/// itself percent-encoded, and for old browsers one of plain characters. No name can end the value or add to it.
std::string attachment(std::string_view name);
/// The text of a percent-encoded part of a URL; empty if a % is not followed by two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view text);

}  // namespace stylet::serve
