// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace stylet {

/// Number of bytes of the UTF-8 character at the beginning of a text; 0 if the text is empty or begins with none.
std::size_t utf8_length(std::string_view text);

/// A text of a file that may be shown: control characters (C0, C1, delete), with which a file could steer a terminal,
/// become blanks, and bytes that are not UTF-8 become U+FFFD.
std::string printable(std::string_view text);

/// The same for a text of several lines: line feeds and tabs stay.
std::string printable_lines(std::string_view text);

}  // namespace stylet
