// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the errors in the table of the needle models. Times are not checked.
#include "stylet/measure/needle_bench.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace stylet::measure {
namespace {

TEST(NeedleBench, every_models_default_is_within_the_accuracy_promised) {
  const auto rows = bench_needles();
  ASSERT_TRUE(rows.ok());
  std::map<std::string, int> defaults;
  for (const NeedleRow& row : *rows) {
    if (!row.is_default) continue;
    ++defaults[row.model];
    EXPECT_LT(std::abs(row.small_inner), 0.005) << row.model;
    EXPECT_LT(std::abs(row.small_tip), 0.002) << row.model;
    for (std::size_t i = 0; i < row.elastica.size(); ++i) {
      EXPECT_LT(std::abs(row.elastica[i]), 0.002) << row.model << row.kTipSlopes_deg[i];
      EXPECT_LT(std::abs(row.shortening[i]), 0.005) << row.model << row.kTipSlopes_deg[i];
    }
  }
  EXPECT_EQ(defaults, (std::map<std::string, int>{{"beam", 1}, {"springs", 1}, {"tet", 1}}));
}

TEST(NeedleBench, beam_and_springs_converge_with_the_square_of_the_elements_number) {
  const auto rows = bench_needles();
  ASSERT_TRUE(rows.ok());
  for (std::size_t k = 1; k < rows->size(); ++k) {
    const NeedleRow& coarse = (*rows)[k - 1];
    const NeedleRow& fine = (*rows)[k];
    if (coarse.model != fine.model || fine.model == "tet") continue;
    ASSERT_EQ(fine.elements, 2 * coarse.elements);
    EXPECT_NEAR(coarse.small_tip / fine.small_tip, 4.0, 0.2) << fine.model << fine.elements;
    EXPECT_NEAR(coarse.elastica[3] / fine.elastica[3], 4.0, 0.4) << fine.model << fine.elements;
  }
}

}  // namespace
}  // namespace stylet::measure
