// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept_token.hpp"
#include "support/folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace fs = std::filesystem;
using stylet::serve::kept_token;

namespace {

struct KeptToken : testing::Test {
  stylet::test::Folder folder;
  fs::path file = folder / "stylet" / "live_token";
};

}  // namespace

TEST_F(KeptToken, stays_the_same_and_is_for_this_user_only) {
  const std::string token = kept_token(file);
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(fs::status(file).permissions(), fs::perms(0600));
  EXPECT_EQ(kept_token(file), token);
}

TEST_F(KeptToken, that_others_could_read_or_that_is_damaged_is_replaced) {
  const std::string token = kept_token(file);
  fs::permissions(file, fs::perms(0644));
  const std::string second = kept_token(file);
  EXPECT_NE(second, token);
  EXPECT_EQ(fs::status(file).permissions(), fs::perms(0600));
  std::ofstream(file) << "short";
  EXPECT_EQ(kept_token(file).size(), 32u);
  fs::remove(file);
  fs::create_symlink(folder / "elsewhere", file);
  EXPECT_EQ(kept_token(file).size(), 32u);
  EXPECT_FALSE(fs::is_symlink(file));
  EXPECT_FALSE(fs::exists(folder / "elsewhere"));
}

TEST_F(KeptToken, that_cannot_be_kept_is_a_new_one_each_time) {
  EXPECT_NE(kept_token(""), kept_token(""));
  std::ofstream(folder / "stylet") << "a file where the folder should be";
  const std::string token = kept_token(file);
  EXPECT_EQ(token.size(), 32u);
  EXPECT_NE(kept_token(file), token);
}
