// SPDX-License-Identifier: GPL-3.0-or-later
// The springs that are lent at the shaft contacts.
#include "coupling/balance/lent_springs.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace stylet {
namespace {

const Vec3 kAlong = Vec3(0.2, -0.3, 1.0).normalized();

TEST(LentSprings, only_contacts_with_a_spring_take_place) {
  LentSprings springs(4);
  springs.take(std::vector<LentSpring>{{kAlong, 0.0}, {kAlong, 0.5}, {kAlong, 0.0}, {kAlong, 2.0}});
  ASSERT_EQ(springs.count(), 2);
  EXPECT_EQ(springs.rows(), 4);
  EXPECT_EQ(springs.grip(0), 1);
  EXPECT_EQ(springs.grip(1), 3);
  EXPECT_EQ(springs.flexibility(0), 2.0);
  EXPECT_EQ(springs.flexibility(1), 0.5);
  EXPECT_TRUE(springs.are_among_first(4));
  EXPECT_FALSE(springs.are_among_first(3));
}

TEST(LentSprings, are_replaced_by_the_next_ones) {
  LentSprings springs(2);
  springs.take(std::vector<LentSpring>{{kAlong, 1.0}, {kAlong, 1.0}});
  springs.take({});
  EXPECT_EQ(springs.count(), 0);
  EXPECT_TRUE(springs.are_among_first(0));
}

TEST(LentSprings, the_two_directions_span_what_a_spring_holds) {
  // E Eᵀ is the projection I − t tᵀ of LentSpring::matrix().
  LentSprings springs(1);
  for (const Vec3& along : {kAlong, Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())}) {
    const LentSpring spring{along, 3.0};
    springs.take(std::vector<LentSpring>{spring});
    const auto& E = springs.directions(0);
    EXPECT_LT((E * E.transpose() / springs.flexibility(0) - spring.matrix()).norm(), 1e-14);
  }
}

TEST(LentSprings, forces_and_components_belong_to_the_springs_contacts) {
  LentSprings springs(3);
  springs.take(std::vector<LentSpring>{{kAlong, 0.0}, {kAlong, 0.5}, {Vec3::UnitY(), 2.0}});
  VecX y = VecX::LinSpaced(9, -1.0, 2.0);
  VecX along(4);
  springs.across(y, along);
  EXPECT_LT((along.head<2>() - springs.directions(0).transpose() * y.segment<3>(3)).norm(), 1e-15);
  EXPECT_LT((along.tail<2>() - springs.directions(1).transpose() * y.segment<3>(6)).norm(), 1e-15);

  const VecX before = y;
  const VecX f = VecX::LinSpaced(4, 1.0, 4.0);
  springs.add_forces(f, y);
  EXPECT_EQ(y.head<3>(), before.head<3>());
  EXPECT_LT((y.segment<3>(3) - before.segment<3>(3) - springs.directions(0) * f.head<2>()).norm(), 1e-15);
  EXPECT_LT((y.tail<3>() - before.tail<3>() - springs.directions(1) * f.tail<2>()).norm(), 1e-15);
}

}  // namespace
}  // namespace stylet
