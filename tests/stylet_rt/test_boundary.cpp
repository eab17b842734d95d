// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet_rt/boundary.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

using namespace stylet;
using namespace stylet::rt;

TEST(ErrorText, is_cut_between_characters_and_ends_in_a_zero) {
  std::array<char, 8> text{};
  text.fill('x');
  ErrorText error(text.data(), 6);
  EXPECT_STREQ(text.data(), "");
  error.say("1 → 2");
  EXPECT_STREQ(text.data(), "1 →");
  error.say("1  → 2");
  EXPECT_STREQ(text.data(), "1  ");
  EXPECT_EQ(text[6], 'x');
  ErrorText nowhere(nullptr, 0);
  nowhere.say("unheard");
}

TEST(Boundary, lets_no_exception_out) {
  std::array<char, 64> text{};
  ErrorText error(text.data(), text.size());
  EXPECT_EQ(guarded(error, []() -> stylet_rt_status { throw std::bad_alloc(); }), STYLET_RT_OUT_OF_MEMORY);
  EXPECT_STREQ(text.data(), "out of memory");
  EXPECT_EQ(guarded(error, []() -> stylet_rt_status { throw std::runtime_error("what it was"); }), STYLET_RT_FAILED);
  EXPECT_STREQ(text.data(), "an unexpected fault ended the call") << "not in the words of a library";
  EXPECT_EQ(guarded(error, []() -> stylet_rt_status { throw 1; }), STYLET_RT_FAILED);
}
