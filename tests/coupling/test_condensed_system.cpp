// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's condensed system x = K_W y against direct solutions of the mixed problem.
#include "stylet/coupling/paper/condensed_system.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <random>

using namespace stylet;
using stylet::paper::CondensedSystem;

namespace {

/// The compliance of w points, positive definite, with the same changes as K_W.
class Reference {
 public:
  explicit Reference(int points) : frames(static_cast<std::size_t>(points), Mat3::Identity()) {
    const Eigen::Index size = 3 * points;
    MatX root(size, size);
    for (double& x : root.reshaped()) x = normal(random);
    A = root * root.transpose() / static_cast<double>(size) + 0.05 * MatX::Identity(size, size);
    softness = VecX::Zero(size);
  }

  [[nodiscard]] MatX local(const std::vector<int>& points) const {
    const auto size = static_cast<Eigen::Index>(3 * points.size());
    MatX K(size, size);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < points.size(); ++j) {
        K.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) =
            frames[static_cast<std::size_t>(points[i])].transpose() * A.block<3, 3>(3 * points[i], 3 * points[j]) *
            frames[static_cast<std::size_t>(points[j])];
      }
      K.diagonal().segment<3>(static_cast<Eigen::Index>(3 * i)) += softness.segment<3>(3 * points[i]);
    }
    return K;
  }

  /// Largest error of x = K_W y for random y against a solution of the mixed problem, over the largest x.
  double error(const CondensedSystem& system, const std::vector<int>& points) {
    const MatX K = local(points);
    const Eigen::Index size = K.rows();
    VecX force(size);
    for (double& x : force) x = normal(random);
    const VecX u = K * force;
    VecX y = force;
    VecX x = u;
    for (Eigen::Index i = 0; i < size; ++i)
      if (system.is_displacement(static_cast<int>(i))) std::swap(y[i], x[i]);
    return (system.matrix() * y - x).cwiseAbs().maxCoeff() / x.cwiseAbs().maxCoeff();
  }

  int enter(CondensedSystem& system, const std::vector<int>& points, int point) const {
    std::vector<int> all = points;
    all.push_back(point);
    const MatX K = local(all);
    return system.add(K.topRightCorner(K.rows() - 3, 3), K.bottomRightCorner<3, 3>());
  }

  /// Adds points 0 … count − 1.
  std::vector<int> fill(CondensedSystem& system, int count) const {
    std::vector<int> points;
    for (int p = 0; p < count; ++p) {
      enter(system, points, p);
      points.push_back(p);
    }
    return points;
  }

  Mat3 turn(double angle) {
    return Eigen::AngleAxisd(angle, Vec3(normal(random), normal(random), normal(random)).normalized())
        .toRotationMatrix();
  }

  std::mt19937_64 random{4};
  std::normal_distribution<double> normal;
  MatX A;
  VecX softness;
  std::vector<Mat3> frames;
};

}  // namespace

TEST(CondensedSystem, follows_switches_rotations_and_contacts_that_come_and_go) {
  constexpr int kPoints = 12;
  Reference reference(kPoints);
  CondensedSystem system(kPoints);
  std::vector<int> points;  // in the order of K_W
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  int added = 0;
  int removed = 0;
  for (int k = 0; k < 3000; ++k) {
    const double what = chance(reference.random);
    const auto some =
        static_cast<int>(reference.random() % static_cast<unsigned>(std::max<std::size_t>(points.size(), 1)));
    if (points.size() < 3 || (what < 0.05 && points.size() < kPoints)) {
      int fresh = 0;
      while (std::find(points.begin(), points.end(), fresh) != points.end()) ++fresh;
      reference.softness.segment<3>(3 * fresh).setZero();
      EXPECT_EQ(reference.enter(system, points, fresh), static_cast<int>(points.size()));
      points.push_back(fresh);
      ++added;
    } else if (what < 0.09) {
      system.remove(some);
      points[static_cast<std::size_t>(some)] = points.back();
      points.pop_back();
      ++removed;
    } else if (what < 0.3) {
      const Mat3 S = reference.turn(0.3);
      system.rotate(some, S);
      Mat3& frame = reference.frames[static_cast<std::size_t>(points[static_cast<std::size_t>(some)])];
      frame = frame * S.transpose();
    } else if (what < 0.4) {
      const int axis = static_cast<int>(reference.random() % 3);
      const double softness = chance(reference.random);
      system.set_softness(3 * some + axis, softness);
      reference.softness[3 * points[static_cast<std::size_t>(some)] + axis] = softness;
    } else {
      const int row = 3 * some + static_cast<int>(reference.random() % 3);
      system.control_displacement(row, !system.is_displacement(row));
    }
    if (k % 50 == 0) {
      ASSERT_LT(reference.error(system, points), 1e-9) << "after " << k;
    }
  }
  EXPECT_GT(added, 50);
  EXPECT_GT(removed, 50);
  EXPECT_LT(reference.error(system, points), 1e-9);
}

TEST(CondensedSystem, a_hundred_thousand_switches_lose_few_digits) {
  Reference reference(8);
  CondensedSystem system(8);
  const std::vector<int> points = reference.fill(system, 8);
  for (int k = 0; k < 100000; ++k) {
    const int row = static_cast<int>(reference.random() % 24);
    system.control_displacement(row, !system.is_displacement(row));
  }
  EXPECT_EQ(system.switches(), 100000);
  EXPECT_LT(reference.error(system, points), 1e-9);
}

TEST(CondensedSystem, turning_a_frame_without_bringing_its_rows_to_one_kind_is_wrong) {
  // A similarity transform of a slipping contact (two displacements, one force) mixes millimetres and newtons.
  Reference reference(4);
  CondensedSystem system(4);
  const std::vector<int> points = reference.fill(system, 4);
  system.control_displacement(3, true);
  system.control_displacement(4, true);
  MatX naive = system.matrix();
  const Mat3 S = reference.turn(0.3);
  naive.middleRows<3>(3) = (S * naive.middleRows<3>(3)).eval();
  naive.middleCols<3>(3) = (naive.middleCols<3>(3) * S.transpose()).eval();
  system.rotate(1, S);
  reference.frames[1] = reference.frames[1] * S.transpose();
  EXPECT_LT(reference.error(system, points), 1e-12);
  EXPECT_GT((naive - system.matrix()).cwiseAbs().maxCoeff(), 0.05 * system.matrix().cwiseAbs().maxCoeff());
}
