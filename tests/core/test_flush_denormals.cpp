// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/core/flush_denormals.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace stylet {
namespace {

volatile double smallest = std::numeric_limits<double>::min();
volatile double denormal = std::numeric_limits<double>::denorm_min();

/// Whether results that would be denormal, or denormal operands, count as zero.
bool results_are_zero() { return smallest / 4 == 0.0; }
bool operands_are_zero() { return denormal * 1e300 == 0.0; }

TEST(FlushDenormals, holds_while_it_lives_and_the_mode_before_comes_back) {
  if (!FlushDenormals::available()) GTEST_SKIP() << "not on this processor";
  EXPECT_FALSE(results_are_zero() || operands_are_zero());
  {
    const FlushDenormals outer;
    EXPECT_TRUE(results_are_zero() && operands_are_zero());
    {
      const FlushDenormals inner;
      EXPECT_TRUE(results_are_zero() && operands_are_zero());
    }
    EXPECT_TRUE(results_are_zero() && operands_are_zero()) << "as it was before the inner one";
  }
  EXPECT_FALSE(results_are_zero() || operands_are_zero());
}

}  // namespace
}  // namespace stylet
