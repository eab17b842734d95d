// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <utility>

namespace stylet {

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

bool same(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  const std::string x = folded(trimmed(a));
  const std::string y = folded(trimmed(b));
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [&](char c, char d) { return lower(c) == lower(d); });
}

/// The first character of a text in UTF-8 and its length in bytes; a byte that is not UTF-8 is a character of its own
/// above all of Unicode.
std::pair<std::uint32_t, std::size_t> first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  constexpr std::uint32_t other = 0x110000;
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t length = (lead & 0xE0U) == 0xC0 ? 2 : (lead & 0xF0U) == 0xE0 ? 3 : 0;
  if (length == 0 || length > text.size()) return {other, 1};
  std::uint32_t code = length == 2 ? lead & 0x1FU : lead & 0x0FU;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return {other, 1};
    code = code << 6U | (byte(i) & 0x3FU);
  }
  return {code, length};
}

/// Base letters of U+00C0 to U+017F; '*' = see append_folded().
constexpr std::string_view kBaseLetters =
    "AAAAAA*CEEEEIIIIDNOOOOO*OUUUUY**aaaaaa*ceeeeiiiidnooooo*ouuuuy*y"
    "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlLlLlNnNnNnnNnOoOoOo**RrRrRrSsSsSsSsTtTtTt"
    "UuUuUuUuUuUuWwYyYZzZzZzs";
static_assert(kBaseLetters.size() == 0x180 - 0xC0);

/// Appends a character of Cyrillic in lower case.
void append_cyrillic(std::string& out, std::uint32_t code) {
  if (code >= 0x410 && code <= 0x42F) code += 0x20;
  if (code <= 0x40F) code += 0x50;
  if (code == 0x451) code = 0x435;  // ё is often written е
  if (code == 0x439) code = 0x438;  // й may also be written as и and a mark
  out += static_cast<char>(0xC0U | code >> 6U);
  out += static_cast<char>(0x80U | (code & 0x3FU));
}

/// Appends the folded form of a character.
void append_folded(std::string& out, std::uint32_t code, std::string_view bytes) {
  if (code == 0xC6 || code == 0xE6) {
    out += code == 0xC6 ? "AE" : "ae";
  } else if (code == 0x152 || code == 0x153) {
    out += code == 0x152 ? "OE" : "oe";
  } else if (code == 0xDF) {
    out += "ss";
  } else if (code >= 0xC0 && code < 0x180 && kBaseLetters[code - 0xC0] != '*') {
    out += kBaseLetters[code - 0xC0];
  } else if (code >= 0x400 && code < 0x460) {
    append_cyrillic(out, code);
  } else if (code >= 0xFF01 && code <= 0xFF5E) {
    out += static_cast<char>(code - 0xFF01 + '!');  // letters as wide as Chinese ones
  } else if (code == 0xA0 || code == 0x3000 || code == 0x30FB || (code >= 0x2000 && code <= 0x206F)) {
    out += ' ';                                // blanks, dashes, quotes
  } else if (code < 0x300 || code >= 0x370) {  // those between are accents on the letter before
    out += bytes;
  }
}

}  // namespace

std::string folded(std::string_view name) {
  std::string out;
  while (!name.empty()) {
    const auto [code, length] = first_character(name);
    append_folded(out, code, name.substr(0, length));
    name.remove_prefix(length);
  }
  return out;
}

std::vector<std::size_t> find_named(std::span<const std::string> names, std::string_view word) {
  if (trimmed(word).empty()) return {};
  std::vector<std::size_t> equal;
  std::vector<std::size_t> alike;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == word) equal.push_back(i);
    if (same(names[i], word)) alike.push_back(i);
  }
  return equal.empty() ? alike : equal;
}

std::vector<std::size_t> find_region(std::span<const std::string> names, std::string_view word) {
  std::vector<std::size_t> found = find_named(names, word);
  const std::string_view number = trimmed(word);
  const std::string_view digits = number.substr(number.starts_with('-') ? 1 : 0);
  if (!found.empty() || digits.empty() || digits.find_first_not_of("0123456789") != std::string_view::npos)
    return found;
  return find_named(names, fmt::format("region {}", number));
}

bool is_listed(std::string_view name, std::span<const std::string> words) {
  if (trimmed(name).empty()) return false;
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return same(name, word); });
}

std::string or_skip(std::string_view name) {
  return fmt::format(" (or leave it out: skip = [\"{}\"] below [patient]; stylet mesh and info: --skip \"{}\")", name,
                     name);
}

}  // namespace stylet
