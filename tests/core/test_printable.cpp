// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/printable.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using namespace std::string_literals;

TEST(Printable, control_characters_become_blanks_and_other_characters_stay) {
  EXPECT_EQ(printable("Pro\x1b[31mstate"), "Pro [31mstate");
  EXPECT_EQ(printable("a\0b\rc\nd\te\x7f"
                      "f"s),
            "a b c d e f");
  EXPECT_EQ(printable("a\xc2\x9b"
                      "31m"),
            "a 31m");
  for (const std::string text : {"Prostata", "Harnröhre", "前立腺", "Простата", "a\u00a0b", "\U0001F600"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, bytes_that_are_not_utf8_are_replaced_one_by_one) {
  const std::string r = "\xEF\xBF\xBD";
  EXPECT_EQ(printable("Harnr\xf6hre"), "Harnr" + r + "hre");
  EXPECT_EQ(printable("\x9b"
                      "31m"),
            r + "31m");
  EXPECT_EQ(printable("\xe5\x89"), r + r);
  EXPECT_EQ(printable("\xe0\x82\x9b"), r + r + r) << "a control character in an overlong form";
  EXPECT_EQ(printable("\xc1\x9b"), r + r);
  EXPECT_EQ(printable("\xed\xa0\x80"), r + r + r) << "half of a surrogate pair";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), r + r + r + r) << "beyond Unicode";
}

TEST(Printable, lines_keep_their_ends) {
  EXPECT_EQ(printable_lines("a\tb\nc\r\x1b"
                            "d\n"),
            "a\tb\nc  d\n");
  EXPECT_EQ(printable("a\nb"), "a b");
}
