// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// The gate for words. A text that comes from a file, a folder's name, a command line or a network may hold control
/// characters, with which it could steer a terminal, and marks that turn the direction of writing. Every place where
/// words leave the program (Error::message(), notices to pages, console, JSON, HTML, CSV, HTTP) passes them through one
/// of these functions, so that nobody else has to.
namespace stylet {

/// Largest number of characters of a name or of a quoted text of unknown origin that a message shows.
inline constexpr std::size_t kLongestQuote = 300;
/// Largest number of characters of a clause of a message, and of a place, which begins with a path.
inline constexpr std::size_t kLongestClause = 1000, kLongestPlace = 5000;

/// Number of bytes of the UTF-8 character at the beginning of a text; 0 if the text is empty or begins with none.
std::size_t utf8_length(std::string_view text);

/// A text that may be shown, in one line: control characters (C0, C1, delete), ends of lines (U+2028, U+2029) and marks
/// of direction (U+061C, U+200E, U+200F, U+202A…U+202E, U+2066…U+2069) become blanks, and bytes that are not UTF-8
/// become U+FFFD.
std::string printable(std::string_view text);

/// The same for a text of several lines: line feeds and tabs stay.
std::string printable_lines(std::string_view text);

/// The text of JSON: the same in its strings, in which control characters stand as escape sequences.
std::string printable_json(std::string_view json);

/// A text with at most so many characters; the last one of a text that was cut is "…".
/// @param text UTF-8, as printable() gives it
std::string shortened(std::string_view text, std::size_t most = kLongestQuote);

/// A name of unknown origin: printable() and shortened().
std::string printable_name(std::string_view text);

/// A text with every part in quotation marks ('…' or "…") cut to kLongestQuote characters, except paths: a part with a
/// slash stays whole.
/// @param text UTF-8, as printable() gives it
std::string with_short_quotes(std::string_view text);

/// A clause of a message: printable(), with_short_quotes() and shortened().
std::string printable_clause(std::string_view text, std::size_t most = kLongestClause);

}  // namespace stylet
