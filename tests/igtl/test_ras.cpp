// SPDX-License-Identifier: GPL-3.0-or-later
#include "igtl/ras.hpp"

#include <gtest/gtest.h>

#include <limits>

using namespace stylet;
using namespace stylet::igtl;

namespace {

/// A TRANSFORM's matrix from the columns of the rotation and the position.
RasMatrix matrix(const Vec3& x, const Vec3& y, const Vec3& z, const Vec3& p) {
  RasMatrix m{};
  std::size_t at = 0;
  for (const Vec3& v : {x, y, z, p})
    for (int i = 0; i < 3; ++i) m[at++] = static_cast<float>(v[i]);
  return m;
}

void expect_near(const RasMatrix& a, const RasMatrix& b) {
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-6) << "element " << k;
}

Pose turned(double w, double x, double y, double z, const Vec3& origin) {
  return {origin, Eigen::Quaterniond(w, x, y, z)};
}

const double kHalf = std::sqrt(0.5);

}  // namespace

TEST(Ras, left_becomes_minus_right_posterior_minus_anterior_superior_stays) {
  EXPECT_EQ(ras(Vec3(1, 2, 3)), Vec3(-1, -2, 3));
  EXPECT_EQ(ras(ras(Vec3(1, 2, 3))), Vec3(1, 2, 3));
}

TEST(Ras, matrices_worked_out_by_hand) {
  // Without rotation, the x axis points to the patient's left, which is −x in RAS.
  expect_near(ras_matrix(turned(1, 0, 0, 0, {5, 7, -11})), matrix({-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {-5, -7, -11}));
  // After a quarter turn about the axis to the left, y points to superior and z to anterior.
  expect_near(ras_matrix(turned(kHalf, kHalf, 0, 0, {10, 20, 30})),
              matrix({-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {-10, -20, 30}));
  // After a third of a turn about (1, 1, 1), x points to posterior, y to superior and z to the left.
  expect_near(ras_matrix(turned(0.5, 0.5, 0.5, 0.5, {-1, 2, -3})),
              matrix({0, -1, 0}, {0, 0, 1}, {-1, 0, 0}, {1, -2, -3}));
}

TEST(Ras, a_matrix_worked_out_by_hand_becomes_its_pose) {
  const auto pose = pose_of(matrix({0, -1, 0}, {0, 0, 1}, {-1, 0, 0}, {1, -2, -3}));
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->origin, Vec3(-1, 2, -3));
  EXPECT_NEAR(pose->rotation.angularDistance(Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)), 0.0, 1e-6);
  EXPECT_NEAR((pose->rotation * Vec3::UnitZ() - Vec3(1, 0, 0)).norm(), 0.0, 1e-6) << "the needle points to the left";
}

TEST(Ras, there_and_back_is_the_same_pose) {
  const Pose pose{{12.5, -3.25, 101}, Eigen::Quaterniond(0.3, -0.7, 0.2, 0.5).normalized()};
  const auto back = pose_of(ras_matrix(pose));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->origin, pose.origin);
  EXPECT_NEAR(back->rotation.angularDistance(pose.rotation), 0.0, 1e-6);
}

TEST(Ras, what_is_no_rigid_motion_is_no_pose) {
  const RasMatrix good = matrix({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 2, 3});
  EXPECT_TRUE(pose_of(good));
  EXPECT_FALSE(pose_of(matrix({1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {1, 2, 3}))) << "mirrored";
  EXPECT_FALSE(pose_of(matrix({1.01, 0, 0}, {0, 1.01, 0}, {0, 0, 1.01}, {1, 2, 3}))) << "scaled";
  EXPECT_FALSE(pose_of(matrix({1, 0, 0}, {0.01, 1, 0}, {0, 0, 1}, {1, 2, 3}))) << "sheared";
  EXPECT_FALSE(pose_of(RasMatrix{})) << "nothing";
  for (std::size_t k = 0; k < good.size(); ++k) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      RasMatrix m = good;
      m[k] = bad;
      EXPECT_FALSE(pose_of(m)) << "element " << k;
    }
  }
}

TEST(Ras, the_rounding_of_single_precision_is_rigid) {
  RasMatrix m = ras_matrix({{1, 2, 3}, Eigen::Quaterniond(0.3, -0.7, 0.2, 0.5).normalized()});
  for (std::size_t k = 0; k < 9; ++k) m[k] *= 1.0F + (k % 2 == 0 ? 1e-6F : -1e-6F);
  EXPECT_TRUE(pose_of(m));
}
