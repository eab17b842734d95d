// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/scenario_io.hpp"

#include "support/folder.hpp"
#include "support/says.hpp"
#include "support/value_of.hpp"

#include <string>

namespace stylet::test {

/// Expects a helpful input error: one line with a place, a value and a cure.
template <class T>
std::string refusal(const Result<T>& result) {
  if (result) {
    ADD_FAILURE() << "taken";
    return {};
  }
  EXPECT_EQ(result.error().kind, ErrorKind::input);
  EXPECT_FALSE(result.error().where.empty());
  EXPECT_FALSE(result.error().what.empty());
  EXPECT_FALSE(result.error().cure.empty());
  const std::string message = result.error().message();
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  return message;
}

}  // namespace stylet::test
