// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stylet::detail {

/// A text without blanks, tabs, line ends and NULs at both ends.
std::string trimmed(std::string_view text);

/// A text in lower case (ASCII letters only).
std::string lower(std::string_view text);

/// The parts of a text between separators; empty parts are kept.
std::vector<std::string_view> split(std::string_view text, char separator);

/// A line of a header, without its end.
struct HeaderLine {
  std::string text;
  bool whole = true;         ///< false: the line is longer than kLongestHeaderLine
  bool lone_return = false;  ///< it ends in a carriage return alone
};
inline constexpr std::size_t kLongestHeaderLine = 65535;

/// Reads the next line, which ends at a line feed, a carriage return or both; empty at the end of the stream. The
/// libraries that read headers disagree on what ends a line, so a check before them must recognise every line end. The
/// stream's state stays good, and tellg() is the position behind the line.
std::optional<HeaderLine> next_header_line(std::istream& stream);

/// Converts a text to a number, independent of the locale; empty if the text is anything but a number with blanks
/// around it.
std::optional<double> to_number(std::string_view text);

}  // namespace stylet::detail
