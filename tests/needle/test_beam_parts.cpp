// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a beam's tangent, in cases that the tests of the whole tangent leave out.
#include "needle/shifted_factor.hpp"
#include "needle/virtual_work.hpp"
#include "support.hpp"

#include <cmath>
#include <limits>

namespace stylet {
namespace {

using beam::BeamShape;
using beam::ShiftedFactor;
using beam::VirtualWork;
using test::kShort;
using test::tilted;

constexpr int kElements = 8;

BeamShape curved_beam() {
  BeamShape shape(kElements, kShort, 15700.0, 12100.0);
  for (Eigen::Index i = 0; i < shape.curvature.size(); ++i)
    shape.curvature[i] = 0.01 * std::sin(1.7 * static_cast<double>(i) + 0.4);
  shape.update();
  return shape;
}

/// Loads inside elements, at the tip and before the clamp, in no order on purpose.
std::vector<PointLoad> some_loads() {
  return {{97.3, {0.21, -0.4, 0.13}}, {kShort, {-0.3, 0.25, -0.5}}, {3.1, {1.1, -0.6, 0.4}}, {-5.0, {1.0, 1.0, 1.0}}};
}

TEST(VirtualWork, follows_every_change_of_shape_base_and_loads) {
  BeamShape shape = curved_beam();
  auto loads = some_loads();
  Mat3 base = Mat3::Identity();
  VirtualWork kept(kElements);
  const auto agrees = [&] {
    VirtualWork fresh(kElements);
    const auto a = kept.of(shape, base, loads);
    const auto b = fresh.of(shape, base, loads);
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  };
  EXPECT_TRUE(agrees());
  EXPECT_TRUE(agrees());
  base = tilted();
  EXPECT_TRUE(agrees());
  loads[1].force.x() += 0.1;
  EXPECT_TRUE(agrees());
  loads[1].s -= 1.0;
  EXPECT_TRUE(agrees());
  loads.pop_back();
  EXPECT_TRUE(agrees());
  shape.curvature[4] += 1e-3;
  shape.update();
  EXPECT_TRUE(agrees());
}

/// A symmetric matrix with eigenvalues from `least` to 2.
MatX with_least_eigenvalue(double least) {
  constexpr Eigen::Index n = 60;
  const MatX root = MatX::NullaryExpr(n, n, [](Eigen::Index i, Eigen::Index j) {
    return std::sin(1.0 + 3.7 * static_cast<double>(i) + 1.3 * static_cast<double>(i * j));
  });
  const MatX Q = Eigen::HouseholderQR<MatX>(root).householderQ();
  return Q * VecX::LinSpaced(n, least, 2.0).asDiagonal() * Q.transpose();
}

TEST(ShiftedFactor, shifts_an_indefinite_matrix_by_more_than_its_least_eigenvalue) {
  for (const double least : {-0.01, -0.3, -7.0}) {
    const MatX H = with_least_eigenvalue(least);
    ShiftedFactor factor(H.rows());
    factor.matrix() = H;
    ASSERT_TRUE(factor.factorise(Indefinite::shift));
    EXPECT_GT(factor.shift(), -least);
    EXPECT_LT(factor.shift(), std::max(0.11, -4.0 * least));
    EXPECT_EQ(factor.matrix(), H);
    MatX Y = MatX::Ones(H.rows(), 1);
    factor.solve_lower(0, Y);
    factor.solve_upper(Y);
    EXPECT_LT((H * Y + factor.shift() * Y - MatX::Ones(H.rows(), 1)).norm(), 1e-11) << least;
  }
}

TEST(ShiftedFactor, ends_with_a_finite_factor_when_the_matrix_is_not_finite) {
  ShiftedFactor factor(6);
  factor.matrix().setIdentity();
  factor.matrix()(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(factor.factorise(Indefinite::shift));
  MatX Y = MatX::Ones(6, 1);
  factor.solve_lower(0, Y);
  EXPECT_TRUE(Y.allFinite());
}

}  // namespace
}  // namespace stylet
