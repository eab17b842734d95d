// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

/// Small conversions for HTML pages.
namespace stylet::results {

/// Text for an element or a quoted attribute: & < > " ' become entities.
std::string html_escaped(std::string_view text);

/// Escaped text whose numbers stay on one line with their units ("0.42 N").
std::string html_prose(std::string_view text);

/// Source text for a <script> element. Inside one, "</script" would end it and "<!--" would change how it is read; both
/// get a backslash, which changes no JavaScript string, template or regular expression.
std::string script_safe(std::string_view javascript);

/// JSON for a <script> element: every "<" written as an escape, which JSON allows inside strings, its only place.
std::string json_script_safe(std::string_view json);

/// RFC 4648 base 64, with padding.
std::string base64(std::span<const std::byte> bytes);

template <class Number>
std::string base64_of(std::span<const Number> numbers) {
  return base64(std::as_bytes(numbers));
}

}  // namespace stylet::results
