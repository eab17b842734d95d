// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/printable.hpp"

#include <algorithm>

namespace stylet {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

unsigned char byte(std::string_view text, std::size_t at) { return static_cast<unsigned char>(text[at]); }

/// Whether a character of UTF-8 of this length steers a terminal.
bool is_control(std::string_view text, std::size_t length) {
  if (length == 1) return byte(text, 0) < 0x20 || byte(text, 0) == 0x7F;
  return length == 2 && byte(text, 0) == 0xC2 && byte(text, 1) < 0xA0;
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

}  // namespace stylet
