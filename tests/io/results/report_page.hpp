// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <string_view>

namespace stylet::testing {

/// Number of occurrences of `word` in `text`.
inline std::size_t count(std::string_view text, std::string_view word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + word.size())) ++found;
  return found;
}

/// Expects that each of these parts is in a text, and only once.
inline void expect_once(std::string_view text, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts)
    EXPECT_EQ(count(text, part), 1U) << part << " in:\n" << text.substr(0, 2000);
}

/// The text between the first `begin` and the next `end` behind it.
inline std::string between(std::string_view text, std::string_view begin, std::string_view end) {
  const std::size_t from = text.find(begin);
  if (from == std::string_view::npos) return {};
  const std::size_t start = from + begin.size();
  return std::string(text.substr(start, text.find(end, start) - start));
}

/// The page without the contents of its scripts and styles.
inline std::string markup(std::string page) {
  for (const auto& [begin, end] : {std::pair{"<script", "</script>"}, std::pair{"<style", "</style>"}}) {
    for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at)) {
      page.erase(at, page.find(end, at) + std::string_view(end).size() - at);
    }
  }
  return page;
}

}  // namespace stylet::testing
