// SPDX-License-Identifier: GPL-3.0-or-later
#include "access.hpp"

#include <gtest/gtest.h>

using namespace stylet::serve;
using Verdict = Access::Verdict;

TEST(Access, of_this_machine_everybody_may_come_in_where_no_token_is_asked_for) {
  const Access access("");
  EXPECT_EQ(access.check("/live", "localhost:8080", "http://localhost:8080"), Verdict::granted);
  EXPECT_EQ(access.check("/live", "127.0.0.1:8080", "http://127.0.0.1:8080"), Verdict::granted);
  EXPECT_EQ(access.check("/live", "[::1]:8080", "http://[::1]:8080"), Verdict::granted);
  EXPECT_EQ(access.check("/live", "localhost:8080", ""), Verdict::granted) << "a program that is no browser";
}

TEST(Access, a_page_of_another_origin_is_kept_out) {
  for (const Access& access : {Access(""), Access("secret")}) {
    for (const char* origin : {"http://evil.example", "http://localhost:9999", "https://localhost.evil.example:8080",
                               "null", "localhost:8080"})
      EXPECT_EQ(access.check("/live?token=secret", "localhost:8080", origin), Verdict::foreign) << origin;
  }
}

TEST(Access, a_foreign_name_that_points_to_this_machine_is_refused) {
  for (const Access& access : {Access(""), Access("secret"), Access("", Access::Names::any)}) {
    for (const char* host :
         {"evil.example:8080", "evil.example", "localhost.evil.example", "127.0.0.1.evil.example:8080", ""}) {
      EXPECT_EQ(access.check("/live?token=secret", host, std::string("http://") + host), Verdict::foreign) << host;
      EXPECT_EQ(access.check_open(host), Verdict::foreign) << host;
    }
  }
}

TEST(Access, only_the_whole_token_lets_in) {
  const Access access("0123abcd", Access::Names::any);
  EXPECT_EQ(access.check("/live?token=0123abcd", "sim.example:80", "http://sim.example:80"), Verdict::granted);
  EXPECT_EQ(access.check("/live?x=1&token=0123abcd", "sim.example:80", ""), Verdict::granted);
  for (const char* target : {"/live", "/live?", "/live?token=", "/live?token=0123abc", "/live?token=0123abcde",
                             "/live?nottoken=0123abcd", "/live?token=0123ABCD", "/token=0123abcd"})
    for (const char* host : {"sim.example:80", "localhost:8080"})
      EXPECT_EQ(access.check(target, host, ""), Verdict::no_token) << target;
}

TEST(Access, tokens_are_long_and_never_the_same) {
  const std::string a = random_token();
  EXPECT_EQ(a.size(), 32u);
  EXPECT_EQ(a.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(a, random_token());
}

TEST(Access, a_token_must_be_the_same_in_an_address) {
  EXPECT_TRUE(is_plain_token("aZ09-._~"));
  for (const char* token : {"", "a b", "a&b", "a#b", "a%20", "ä"}) EXPECT_FALSE(is_plain_token(token)) << token;
}
