// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the parts of the beam's tangent one by one.
#include "needle/load_pulls.hpp"
#include "needle/scaled_chain.hpp"
#include "needle/shifted_factor.hpp"
#include "needle/virtual_work.hpp"
#include "support.hpp"

#include <cmath>
#include <limits>

namespace stylet {
namespace {

using beam::BeamShape;
using beam::dof;
using beam::ElementKind;
using beam::LoadPulls;
using beam::ScaledChain;
using beam::ShiftedFactor;
using beam::VirtualWork;
using test::kShort;
using test::tilted;

constexpr int kElements = 8;

BeamShape curved(ElementKind kind) {
  BeamShape shape(kElements, kShort, 15700.0, 12100.0, kind);
  for (Eigen::Index i = 0; i < shape.curvature.size(); ++i)
    shape.curvature[i] = 0.01 * std::sin(1.7 * static_cast<double>(i) + 0.4);
  shape.update();
  return shape;
}

/// Loads inside elements, at the tip and before the clamp, in no order on purpose.
std::vector<PointLoad> some_loads() {
  return {{97.3, {0.21, -0.4, 0.13}}, {kShort, {-0.3, 0.25, -0.5}}, {3.1, {1.1, -0.6, 0.4}}, {-5.0, {1.0, 1.0, 1.0}}};
}

/// Derivative of a function of the shape with respect to curvature component i, by central differences.
template <class Function>
auto derivative(BeamShape shape, Eigen::Index i, Function&& function) {
  constexpr double h = 1e-6;
  const double centre = shape.curvature[i];
  const auto at = [&](double value) {
    shape.curvature[i] = value;
    shape.update();
    return function(shape);
  };
  using Value = decltype(at(h));
  const Value above = at(centre + h);
  const Value below = at(centre - h);
  return Value((above - below) / (2.0 * h));
}

TEST(VirtualWork, is_the_derivative_of_the_loads_work_with_respect_to_curvature) {
  const auto loads = some_loads();
  for (const ElementKind kind : {ElementKind::arc, ElementKind::rod}) {
    const BeamShape shape = curved(kind);
    VirtualWork work(kElements);
    work.reserve(4);
    const auto found = work.of(shape, tilted(), loads);
    ASSERT_EQ(found.size(), static_cast<std::size_t>(kElements));
    for (int e = 0; e < kElements; ++e) {
      for (int k = 0; k < 3; ++k) {
        const double expected = derivative(shape, dof(e) + k, [&](const BeamShape& s) {
          double done = 0.0;
          for (const PointLoad& load : loads) done += load.force.dot(tilted() * s.point(load.s));
          return done;
        });
        EXPECT_NEAR(found[static_cast<std::size_t>(e)][k], expected, 1e-5) << e << ' ' << k;
      }
    }
  }
}

TEST(VirtualWork, follows_every_change_of_shape_base_and_loads) {
  BeamShape shape = curved(ElementKind::arc);
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

TEST(LoadPulls, of_a_load_pull_together_as_the_load_does_at_its_point) {
  for (const ElementKind kind : {ElementKind::arc, ElementKind::rod}) {
    const BeamShape shape = curved(kind);
    LoadPulls pulls;
    pulls.reserve(4);
    const auto loads = some_loads();
    for (const PointLoad& load : loads) pulls.add(shape, tilted(), load);
    ASSERT_EQ(pulls.count(), 4);
    std::size_t all = 0;
    for (Eigen::Index c = 0; c < 4; ++c) {
      const PointLoad& load = loads[static_cast<std::size_t>(c)];
      Vec3 force = Vec3::Zero();
      int last = -1;
      for (const auto& pull : pulls.of(c)) {
        force += pull.force;
        last = std::max(last, pull.at.element);
      }
      if (kind == ElementKind::arc) {
        EXPECT_LT((force - tilted().transpose() * load.force).norm(), 1e-14) << c;
      }
      EXPECT_EQ(pulls.last_moved(c), last) << c;
      all += pulls.of(c).size();
    }
    EXPECT_EQ(pulls.all().size(), all);
    EXPECT_EQ(pulls.last_moved(3), -1);  // before the clamp
    EXPECT_EQ(pulls.last_moved(0, 4), kElements - 1);
    EXPECT_EQ(pulls.last_moved(2, 4), pulls.last_moved(2));
  }
}

TEST(LoadPulls, keep_the_first_loads_as_they_are) {
  const BeamShape shape = curved(ElementKind::rod);
  LoadPulls pulls;
  const auto loads = some_loads();
  for (const PointLoad& load : loads) pulls.add(shape, tilted(), load);
  const auto second = pulls.of(1).size();
  pulls.keep_first(2);
  EXPECT_EQ(pulls.count(), 2);
  EXPECT_EQ(pulls.of(1).size(), second);
  EXPECT_EQ(pulls.all().size(), pulls.of(0).size() + second);
  pulls.add(shape, tilted(), loads.front());
  EXPECT_EQ(pulls.of(2).size(), pulls.of(0).size());
  pulls.keep_first(0);
  EXPECT_EQ(pulls.count(), 0);
  EXPECT_TRUE(pulls.all().empty());
}

TEST(ScaledChain, its_scales_make_the_elastic_energy_half_a_sum_of_squares) {
  for (const ElementKind kind : {ElementKind::arc, ElementKind::rod}) {
    const BeamShape shape = curved(kind);
    const ScaledChain chain(shape);
    double sum = 0.0;
    for (int e = 0; e < kElements; ++e) sum += 0.5 * shape.strain(e).cwiseQuotient(chain.scale(e)).squaredNorm();
    EXPECT_NEAR(sum, shape.energy(), 1e-12 * shape.energy());
  }
}

TEST(ScaledChain, rows_run_from_the_tip_to_the_base) {
  const ScaledChain chain(curved(ElementKind::arc));
  EXPECT_EQ(chain.elements(), kElements);
  EXPECT_EQ(chain.rows(), 3 * kElements);
  EXPECT_EQ(chain.row(kElements - 1), 0);
  EXPECT_EQ(chain.row(0), 3 * kElements - 3);
  EXPECT_EQ(chain.row(-1), chain.rows());
}

TEST(ScaledChain, motion_is_the_derivative_of_a_loads_point) {
  for (const ElementKind kind : {ElementKind::arc, ElementKind::rod}) {
    const BeamShape shape = curved(kind);
    ScaledChain chain(shape);
    chain.update(shape);
    for (const PointLoad& load : some_loads()) {
      LoadPulls pulls;
      pulls.add(shape, tilted(), load);
      Eigen::Matrix<double, Eigen::Dynamic, 3> motion(chain.rows(), 3);
      chain.motion(pulls.of(0), tilted(), motion);
      for (int e = 0; e < kElements; ++e) {
        for (int k = 0; k < 3; ++k) {
          const Vec3 expected = chain.scale(e)[k] * derivative(shape, dof(e) + k, [&](const BeamShape& s) {
                                  return Vec3(tilted() * s.point(load.s));
                                });
          EXPECT_LT((motion.row(chain.row(e) + k).transpose() - expected).norm(), 1e-6) << load.s << ' ' << e;
        }
      }
      // Elements beyond the last one that moves the point have no effect.
      EXPECT_TRUE(motion.topRows(chain.row(pulls.last_moved(0))).isZero(0.0)) << load.s;
    }
  }
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

TEST(ShiftedFactor, solves_with_a_definite_matrix_as_it_is) {
  const MatX H = with_least_eigenvalue(0.1);
  ShiftedFactor factor(H.rows());
  EXPECT_FALSE(factor.factorised());
  factor.matrix() = H;
  ASSERT_TRUE(factor.factorise(Indefinite::give_up));
  EXPECT_TRUE(factor.factorised());
  EXPECT_EQ(factor.shift(), 0.0);
  MatX Y = MatX::Zero(H.rows(), 2);
  Y.bottomRows(20).setOnes();
  const MatX b = Y;
  factor.solve_lower(H.rows() - 20, Y);
  EXPECT_TRUE(Y.topRows(H.rows() - 20).isZero(0.0));
  factor.solve_upper(Y);
  EXPECT_LT((H * Y - b).norm(), 1e-12 * b.norm());
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

TEST(ShiftedFactor, gives_up_an_indefinite_matrix_where_it_is_told_to) {
  ShiftedFactor factor(60);
  factor.matrix() = with_least_eigenvalue(-0.3);
  EXPECT_FALSE(factor.factorise(Indefinite::give_up));
  EXPECT_FALSE(factor.factorised());
  factor.matrix() = with_least_eigenvalue(0.3);
  EXPECT_TRUE(factor.factorise(Indefinite::give_up));
  EXPECT_TRUE(factor.factorised());
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
