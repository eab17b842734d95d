// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/printable.hpp"

#include <algorithm>

namespace stylet {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

unsigned char byte(std::string_view text, std::size_t at) { return static_cast<unsigned char>(text[at]); }

bool is_within(unsigned char c, unsigned first, unsigned last) { return c >= first && c <= last; }

/// Whether a character of UTF-8 of this length steers a terminal, ends a line or turns the direction of writing.
bool is_control(std::string_view text, std::size_t length) {
  const unsigned char first = byte(text, 0);
  if (length == 1) return first < 0x20 || first == 0x7F;
  const unsigned char second = byte(text, 1);
  if (length == 2) return (first == 0xC2 && second < 0xA0) || (first == 0xD8 && second == 0x9C);
  if (length != 3 || first != 0xE2) return false;
  const unsigned char third = byte(text, 2);
  return (second == 0x80 && (is_within(third, 0x8E, 0x8F) || is_within(third, 0xA8, 0xAE))) ||
         (second == 0x81 && is_within(third, 0xA6, 0xA9));
}

std::string safe(std::string_view text, std::string_view kept) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      out += kReplacement;
      text.remove_prefix(1);
      continue;
    }
    const bool blank = is_control(text, length) && kept.find(text.front()) == std::string_view::npos;
    out += blank ? std::string_view(" ") : text.substr(0, length);
    text.remove_prefix(length);
  }
  return out;
}

bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_character));
}

/// Whether a quotation mark at this place opens a quotation: it follows a blank or an opening bracket.
bool opens(std::string_view text, std::size_t at) {
  return at == 0 || std::string_view(" \n\t([{=,:").find(text[at - 1]) != std::string_view::npos;
}

/// The place of the mark that ends a quotation; the end of the text if there is none.
std::size_t end_of_quote(std::string_view text, std::size_t from, char mark) {
  const std::string_view after(" \n\t)]}=,:;.?!");
  for (std::size_t at = from; at < text.size(); ++at) {
    if (text[at] != mark) continue;
    if (at + 1 == text.size() || after.find(text[at + 1]) != std::string_view::npos) return at;
  }
  return text.size();
}

}  // namespace

std::size_t utf8_length(std::string_view text) {
  if (text.empty()) return 0;
  const unsigned char first = byte(text, 0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  if (length == 0 || length > text.size()) return 0;
  // The second byte is bounded where a shorter form exists, for surrogates, and at the end of Unicode.
  const unsigned char low = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned char high = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  if (byte(text, 1) < low || byte(text, 1) > high) return 0;
  const std::string_view others = text.substr(2, length - 2);
  const bool whole = std::all_of(others.begin(), others.end(),
                                 [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; });
  return whole ? length : 0;
}

std::string printable(std::string_view text) { return safe(text, {}); }

std::string printable_lines(std::string_view text) { return safe(text, "\n\t"); }

std::string printable_json(std::string_view json) {
  std::string text = printable_lines(json);
  if (text.find('\\') == std::string::npos) return text;
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '\\' || at + 1 == text.size()) {
      out += text[at];
      continue;
    }
    const char escaped = text[++at];
    if (escaped == 'u') {  // the writer escapes control characters only in this way
      out += ' ';
      at += 4;
    } else if (escaped == 'b' || escaped == 'f' || escaped == 'r') {
      out += ' ';
    } else {
      (out += '\\') += escaped;
    }
  }
  return out;
}

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most || characters(text) <= most) return std::string(text);
  std::size_t at = 0;
  for (std::size_t kept = 0; at < text.size(); ++at) {
    if (begins_character(text[at]) && ++kept == most) break;
  }
  return std::string(text.substr(0, at)) + "…";
}

std::string printable_name(std::string_view text) { return shortened(printable(text)); }

std::string with_short_quotes(std::string_view text) {
  if (text.size() <= kLongestQuote) return std::string(text);
  std::string out;
  std::size_t at = 0;
  while (at < text.size()) {
    const char c = text[at];
    out += c;
    ++at;
    if ((c != '\'' && c != '"') || !opens(text, at - 1)) continue;
    const std::size_t end = end_of_quote(text, at, c);
    const std::string_view quoted = text.substr(at, end - at);
    out += quoted.find('/') == std::string_view::npos ? shortened(quoted) : std::string(quoted);
    at = end;
  }
  return out;
}

std::string printable_clause(std::string_view text, std::size_t most) {
  return shortened(with_short_quotes(printable(text)), most);
}

}  // namespace stylet
