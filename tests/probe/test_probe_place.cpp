// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/probe_place.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

const ProbeSeat kSeat{{1.0, 40.0, -60.0}, 5.0};

TEST(ProbePlace, at_rest_is_along_the_patient_and_looks_anterior) {
  const ProbePlace place = probe_place({.kind = ProbeKind::biplane}, kSeat);
  EXPECT_LT((place.origin_mm - Vec3(1.0, 40.0, 5.0)).norm(), 1e-12);
  EXPECT_LT((place.axes.col(1) + Vec3::UnitY()).norm(), 1e-12) << "anterior is −y";
  EXPECT_LT((place.axes.col(2) - Vec3::UnitZ()).norm(), 1e-12) << "superior is +z";
  EXPECT_NEAR(place.axes.determinant(), 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(place.radius_mm, 10.0);
}

TEST(ProbePlace, the_stepper_moves_it_as_its_names_say) {
  EXPECT_LT(probe_place({.lift_mm = 8.0}, kSeat).origin_mm.y(), 33.0) << "a lift is anterior";
  EXPECT_GT(probe_place({.tilt_deg = 5.0}, kSeat).axes.col(2).dot(-Vec3::UnitY()), 0.0) << "the end goes anterior";
  EXPECT_GT(probe_place({.roll_deg = 20.0}, kSeat).axes.col(1).x(), 0.3) << "the picture turns to the patient's left";
  const ProbePlace balloon = probe_place({.balloon_mm = 3.0, .depth_mm = 20.0}, kSeat);
  EXPECT_DOUBLE_EQ(balloon.radius_mm, 13.0);
  EXPECT_DOUBLE_EQ(balloon.origin_mm.z(), 20.0);
}

}  // namespace
}  // namespace stylet
