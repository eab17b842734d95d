// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stylet::detail {

/// Without blanks, tabs, line ends and NULs at both ends.
std::string trimmed(std::string_view text);

/// In lower case (ASCII letters only).
std::string lower(std::string_view text);

/// Parts between separators; empty parts are kept.
std::vector<std::string_view> split(std::string_view text, char separator);

/// A line of a header, without its end.
struct HeaderLine {
  std::string text;
  bool whole = true;         ///< false: its end lies beyond kLongestHeaderLine
  bool lone_return = false;  ///< it ends in a carriage return alone
};
inline constexpr std::size_t kLongestHeaderLine = 65535;

/// The next line, which ends at a line feed, a carriage return or both; nothing at the end of the stream. The libraries
/// that read headers differ in what ends a line for them: whoever looks at one before them has to see every end. The
/// stream's state stays good, so that tellg() is what follows the line.
std::optional<HeaderLine> next_header_line(std::istream& stream);

/// The number a text is, blanks at the ends allowed, nothing else beside it; independent of the locale.
std::optional<double> to_number(std::string_view text);

}  // namespace stylet::detail
