// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "support/folder.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>

namespace stylet::testing_files {

/// Expects an input error whose message has this part.
template <class T>
void expect_refused(const Result<T>& result, const std::string& part) {
  ASSERT_FALSE(result.ok()) << part;
  EXPECT_EQ(result.error().kind, ErrorKind::input);
  EXPECT_NE(result.error().message().find(part), std::string::npos) << result.error().message();
  EXPECT_FALSE(result.error().cure.empty());
}

/// A test with a folder of its own.
class InFolder : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file(const std::string& name, const std::string& text) const {
    return test::write_file(folder / name, text);
  }

  test::Folder folder;
};

}  // namespace stylet::testing_files
