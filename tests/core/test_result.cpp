// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/result.hpp"

#include <gtest/gtest.h>

using namespace stylet;

TEST(Result, error_message_names_place_value_and_cure) {
  const Error e =
      input_error("case.dcm, ROI 'Prostate'", "1 slice, at least 2 are needed", "Contour it on more slices");
  EXPECT_EQ(e.message(), "case.dcm, ROI 'Prostate': 1 slice, at least 2 are needed. Contour it on more slices");
}

TEST(Result, holds_a_value_or_an_error) {
  const Result<int> good = 3;
  const Result<int> bad = failure("solver", "no convergence", "Use a smaller time step");
  ASSERT_TRUE(good.ok());
  EXPECT_EQ(*good, 3);
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().kind, ErrorKind::failed);
}
