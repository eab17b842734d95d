// SPDX-License-Identifier: GPL-3.0-or-later
// Directions and order of the rows of the shaft contacts' matrix.
#include "coupling/balance/grip_rows.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace stylet {
namespace {

constexpr Eigen::Index kSpringRows = 4;

/// Contacts along a bent needle; one in the middle yields laterally.
std::vector<Yield> yields(int grips, int yielding) {
  std::vector<Yield> result;
  for (int g = 0; g < grips; ++g)
    result.push_back({Vec3(0.02 * g, -0.01 * g, 1.0).normalized(), g == yielding ? 0.3 : 0.0, 1.0});
  return result;
}

TEST(GripRows, only_rows_without_yield_across_the_needle_are_settled) {
  GripRows rows(10);
  rows.arrange(yields(8, 2), kSpringRows);
  EXPECT_EQ(rows.grips(), 8);
  EXPECT_EQ(rows.count(), 24 + kSpringRows);
  // Contacts 0, 1, 3 and 4; 2 yields, and 5, 6, 7 are next to the tip.
  EXPECT_EQ(rows.settled(), 8);
  for (int g = 0; g < 8; ++g) {
    const bool settled = g == 0 || g == 1 || g == 3 || g == 4;
    EXPECT_EQ(rows.settled(g, 0), settled) << g;
    EXPECT_EQ(rows.settled(g, 1), settled) << g;
    EXPECT_FALSE(rows.settled(g, 2)) << g;
  }
}

TEST(GripRows, every_row_has_a_place_of_its_own_and_the_springs_stand_between) {
  GripRows rows(10);
  rows.arrange(yields(8, 2), kSpringRows);
  rows.append(Vec3::UnitX());
  std::set<Eigen::Index> places;
  for (int g = 0; g < rows.grips(); ++g) {
    for (int k = 0; k < 3; ++k) {
      places.insert(rows.place(g, k));
      EXPECT_EQ(rows.place(g, k) >= rows.first_yielding(), !rows.settled(g, k)) << g << ' ' << k;
    }
  }
  for (Eigen::Index s = 0; s < kSpringRows; ++s) places.insert(rows.settled() + s);
  EXPECT_EQ(static_cast<Eigen::Index>(places.size()), rows.count());
  EXPECT_EQ(*places.begin(), 0);
  EXPECT_EQ(*places.rbegin(), rows.count() - 1);
}

TEST(GripRows, an_added_contact_comes_last_and_leaves_all_others_in_place) {
  GripRows rows(10);
  rows.arrange(yields(8, 2), kSpringRows);
  const GripRows before = rows;
  rows.append(Vec3::UnitX());
  for (int k = 0; k < 3; ++k) EXPECT_EQ(rows.place(8, k), rows.count() - 3 + k);
  EXPECT_EQ(rows.frame(8).col(2), Vec3::UnitX());
  EXPECT_EQ(rows.settled(), before.settled());
  rows.keep_first(8);
  EXPECT_EQ(rows.count(), before.count());
  for (int g = 0; g < 8; ++g) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(rows.place(g, k), before.place(g, k));
  }
}

TEST(GripRows, frames_are_orthonormal_with_the_contacts_direction_last) {
  GripRows rows(8);
  const auto all = yields(8, -1);
  rows.arrange(all, 0);
  for (int g = 0; g < 8; ++g) {
    const Mat3& frame = rows.frame(g);
    EXPECT_LT((frame.transpose() * frame - Mat3::Identity()).norm(), 1e-14);
    EXPECT_EQ(frame.col(2), all[static_cast<std::size_t>(g)].along);
  }
}

TEST(GripRows, order_turns_each_contact_into_its_frame_and_restore_turns_it_back) {
  GripRows rows(8);
  rows.arrange(yields(8, 2), kSpringRows);
  const MatX Y = VecX::LinSpaced(3 * rows.count(), -1.0, 1.0).reshaped(rows.count(), 3);
  MatX ordered(rows.count(), 3);
  rows.order(Y, ordered);
  for (int g = 0; g < 8; ++g) {
    for (int k = 0; k < 3; ++k) {
      const VecX expected = rows.frame(g).col(k).transpose() * Y.middleRows<3>(3 * g);
      EXPECT_LT((ordered.row(rows.place(g, k)).transpose() - expected).norm(), 1e-15) << g << ' ' << k;
    }
  }
  EXPECT_EQ(ordered.middleRows(rows.settled(), kSpringRows), Y.bottomRows(kSpringRows));
  MatX back(rows.count(), 3);
  rows.restore(ordered, back);
  EXPECT_LT((back - Y).norm(), 1e-14);
}

}  // namespace
}  // namespace stylet
