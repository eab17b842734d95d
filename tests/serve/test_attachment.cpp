// SPDX-License-Identifier: GPL-3.0-or-later
// Names of files in addresses and headers.
#include "attachment.hpp"

#include <gtest/gtest.h>

using namespace stylet::serve;

TEST(Attachment, gives_any_name_and_none_ends_the_header) {
  EXPECT_EQ(attachment("2026-11-20-e3.5.csv"),
            "attachment; filename=\"2026-11-20-e3.5.csv\"; filename*=UTF-8''2026-11-20-e3.5.csv");
  EXPECT_EQ(attachment("a\"; b\\é\r\n.csv"),
            "attachment; filename=\"a__ b_____.csv\"; filename*=UTF-8''a%22%3B%20b%5C%C3%A9%0D%0A.csv");
}

TEST(PercentDecoded, is_the_name_that_a_page_has_encoded) {
  EXPECT_EQ(percent_decoded("a%22b%20%c3%A9"), "a\"b é");
  EXPECT_EQ(percent_decoded(""), "");
  for (const char* wrong : {"%", "a%2", "%zz", "%-1", "%2"}) EXPECT_FALSE(percent_decoded(wrong)) << wrong;
}
