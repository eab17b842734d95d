// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

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
  a = trimmed(a);
  b = trimmed(b);
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

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

bool is_listed(std::string_view name, std::span<const std::string> words) {
  if (trimmed(name).empty()) return false;
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return same(name, word); });
}

std::string or_skip(std::string_view name) {
  return fmt::format(" (or leave it out: skip = [\"{}\"] below [patient]; stylet mesh and info: --skip \"{}\")", name,
                     name);
}

}  // namespace stylet
