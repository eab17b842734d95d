// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/survive.hpp"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

using namespace stylet;

namespace {

/// The error that survive() tells for work that throws.
template <class Work>
Error told_of(const Work& work) {
  Error told;
  EXPECT_FALSE(survive("the work", work, [&](const Error& why) { told = why; }));
  EXPECT_EQ(told.where, "the work");
  EXPECT_FALSE(told.cure.empty());
  return told;
}

}  // namespace

TEST(Survive, work_that_ends_by_itself_is_done_and_nothing_is_told) {
  int done = 0;
  EXPECT_TRUE(survive(
      "the work", [&] { ++done; }, [](const Error&) { FAIL(); }));
  EXPECT_EQ(done, 1);
}

TEST(Survive, an_exception_of_any_kind_becomes_an_error_in_our_own_words) {
  EXPECT_EQ(told_of([] { throw std::bad_alloc(); }).what, "there is too little memory");
  const Error refused = told_of([] { throw std::system_error(EAGAIN, std::generic_category(), "library"); });
  EXPECT_EQ(refused.what, "the system refuses it: " + std::generic_category().message(EAGAIN));
  const Error fault = told_of([] { throw std::runtime_error("[json.exception.type_error.316] library"); });
  EXPECT_EQ(fault.what.find("library"), std::string::npos);
  EXPECT_EQ(told_of([] { throw 1; }).what, fault.what);
}

TEST(Survive, a_message_that_cannot_be_told_ends_nothing) {
  EXPECT_FALSE(survive(
      "the work", [] { throw 1; }, [](const Error&) { throw std::bad_alloc(); }));
}

TEST(Survive, a_test_can_throw_at_a_place) {
  throw_for_tests = [](std::string_view place) {
    if (place == "here") throw 1;
  };
  int done = 0;
  EXPECT_FALSE(survive(
      "here", [&] { ++done; }, [](const Error&) {}));
  EXPECT_TRUE(survive(
      "there", [&] { ++done; }, [](const Error&) {}));
  throw_for_tests = nullptr;
  EXPECT_EQ(done, 1);
}
