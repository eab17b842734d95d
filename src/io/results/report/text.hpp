// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

/// Text conversions for HTML pages.
namespace stylet::results {

/// Escapes a text for an element or a quoted attribute: & < > " ' become entities, and control characters blanks
/// (printable_lines()).
std::string html_escaped(std::string_view text);

/// Escapes a text, keeps numbers and their units on one line ("0.42 N"), and puts minus signs (with_minus_signs()).
std::string html_prose(std::string_view text);

/// Puts the minus sign (U+2212) in the place of each hyphen that stands before a number and after no letter, digit or
/// hyphen: "-1.5" becomes "−1.5"; "I-125" and "2024-01-31" stay.
std::string with_minus_signs(std::string_view text);

/// Converts JavaScript for a <script> element, in which "</script" would end the element and "<!--" would change its
/// parsing. Both get a backslash, which does not change any JavaScript string, template or regular expression.
std::string script_safe(std::string_view javascript);

/// Converts JSON for a <script> element: every "<" becomes an escape sequence. JSON allows that in strings, and "<"
/// cannot occur elsewhere.
std::string json_script_safe(std::string_view json);

/// Base 64 (RFC 4648) with padding.
std::string base64(std::span<const std::byte> bytes);

template <class Number>
std::string base64_of(std::span<const Number> numbers) {
  return base64(std::as_bytes(numbers));
}

}  // namespace stylet::results
