// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string_view>

namespace stylet::test {

/// Expects that a text has all of these parts.
inline void expect_says(std::string_view text, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts)
    EXPECT_NE(text.find(part), std::string_view::npos) << '"' << part << "\" is not in:\n" << text.substr(0, 2000);
}

/// Expects that a text has none of these parts.
inline void expect_silent(std::string_view text, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) EXPECT_EQ(text.find(part), std::string_view::npos) << part;
}

}  // namespace stylet::test
