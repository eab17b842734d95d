// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/theory.hpp"
#include "support.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace stylet {
namespace {

using test::kEI;
using test::kLength;
constexpr double kGJ = 12094.0;
constexpr double kDegree = std::numbers::pi / 180.0;

struct Elastica : stylet::Elastica {
  explicit Elastica(double tip_slope) : stylet::Elastica(tip_slope, kLength, kEI) {}
};

double slope(const Needle& needle, double s) { return std::asin(needle.tangent(s).x()); }

/// Computes a table of docs/theory/needle.md: run this test with --gtest_filter and read its output.
TEST(BeamLargeDeflection, error_falls_with_the_square_of_the_element_length) {
  const Elastica exact(60.0 * kDegree);
  const std::vector<PointLoad> loads = {{kLength, {exact.force, 0, 0}}};
  double previous = 0.0;
  std::printf("elements | tip deflection | axial shortening | tip slope (errors, 60 degree elastica)\n");
  for (const int elements : {4, 8, 12, 24, 48, 96}) {
    const auto needle = test::beam(elements);
    test::settle(*needle, loads, 1e-8);
    const double deflection = needle->point(kLength).x() / exact.deflection - 1.0;
    const double shortening = (kLength - needle->point(kLength).z()) / (kLength - exact.reach) - 1.0;
    const double turn = slope(*needle, kLength) / (60.0 * kDegree) - 1.0;
    std::printf("%8d | %13.4f%% | %15.4f%% | %8.4f%%\n", elements, 100 * deflection, 100 * shortening, 100 * turn);
    if (elements == 24 || elements == 48 || elements == 96) {
      if (elements != 24) {
        EXPECT_NEAR(std::log2(previous / deflection), 2.0, 0.1) << elements;
      }
      previous = deflection;
    }
  }
}

/// Lateral tip compliance [mm/N] of a straight column under an axial force.
double lateral_compliance(double push) {
  const auto needle = test::beam(24);
  const std::vector<PointLoad> loads = {{kLength, {0, 0, -push}}};
  return test::compliance_of(*needle, loads)(0, 0);
}

TEST(BeamBuckling, lateral_compliance_follows_the_beam_column_and_diverges_at_eulers_load) {
  const double euler = std::numbers::pi * std::numbers::pi * kEI / (4.0 * kLength * kLength);
  for (const double share : {0.2, 0.5, 0.8}) {
    const double push = share * euler;
    const double k = std::sqrt(push / kEI);
    const double exact = (std::tan(k * kLength) - k * kLength) / (k * push);
    EXPECT_NEAR(lateral_compliance(push), exact, 0.01 * exact) << share;
  }
  // The stiffness 1/c falls to zero at the buckling load, which is extrapolated from just below.
  const double a = 0.97 * euler;
  const double b = 0.98 * euler;
  const double stiffness_a = 1.0 / lateral_compliance(a);
  const double stiffness_b = 1.0 / lateral_compliance(b);
  const double critical = b + stiffness_b * (b - a) / (stiffness_a - stiffness_b);
  EXPECT_NEAR(critical, euler, 0.01 * euler);
}

TEST(BeamBuckling, pushed_past_eulers_load_it_finds_the_bent_equilibrium) {
  const double euler = std::numbers::pi * std::numbers::pi * kEI / (4.0 * kLength * kLength);
  // Post-buckling elastica whose tip slope is 60° to the axis: P/P_E = (2 K(sin 30°)/π)².
  const double k = std::sin(30.0 * kDegree);
  const double ratio = std::pow(2.0 * std::comp_ellint_1(k) / std::numbers::pi, 2);
  const auto needle = test::beam(24);
  std::vector<PointLoad> loads = {{kLength, {0.05, 0.0, -ratio * euler}}};
  test::settle(*needle, loads);
  loads[0].force.x() = 0.0;
  test::settle(*needle, loads);
  EXPECT_NEAR(slope(*needle, kLength), 60.0 * kDegree, 0.01 * 60.0 * kDegree);
  const double deflection = 2.0 * k * kLength / std::comp_ellint_1(k);
  EXPECT_NEAR(needle->point(kLength).x(), deflection, 0.01 * deflection);
}

/// Kirchhoff rod by shooting: the same statics as differential equations, integrated with the classical Runge–Kutta
/// rule. The unknown is the moment at the clamp, the condition a tip without moment.
class ShootingRod {
 public:
  explicit ShootingRod(std::vector<PointLoad> loads) : loads_(std::move(loads)) {
    for (int iteration = 0; iteration < 50; ++iteration) {
      const Vec3 miss = shoot(base_moment_);
      if (miss.norm() < 1e-10) break;
      Mat3 J;
      for (int i = 0; i < 3; ++i) {
        const Vec3 h = 1e-4 * Vec3::Unit(i);
        J.col(i) = (shoot(base_moment_ + h) - shoot(base_moment_ - h)) / 2e-4;
      }
      base_moment_ -= J.inverse() * miss;
    }
    EXPECT_LT(shoot(base_moment_).norm(), 1e-9);
  }
  [[nodiscard]] const Vec3& tip() const { return r_; }
  [[nodiscard]] Vec3 tip_tangent() const { return R_.col(2); }
  [[nodiscard]] double largest_twist() const { return twist_; }

 private:
  struct Rate {
    Vec3 r, m;
    Mat3 R;
  };
  static Rate rate(const Mat3& R, const Vec3& m, const Vec3& n) {
    const Vec3 local = R.transpose() * m;
    const Vec3 spin = R * Vec3(local.x() / kEI, local.y() / kEI, local.z() / kGJ);
    Mat3 turn;
    for (int i = 0; i < 3; ++i) turn.col(i) = spin.cross(R.col(i));
    return {R.col(2), -R.col(2).cross(n), turn};
  }
  Vec3 shoot(const Vec3& base_moment) {
    constexpr int steps = 2000;
    constexpr double h = kLength / steps;
    R_ = Mat3::Identity();
    r_ = Vec3::Zero();
    Vec3 m = base_moment;
    twist_ = 0.0;
    for (int i = 0; i < steps; ++i) {
      Vec3 n = Vec3::Zero();
      for (const PointLoad& load : loads_) {
        if (load.s > (i + 0.5) * h) n += load.force;
      }
      const Rate a = rate(R_, m, n);
      const Rate b = rate(R_ + h / 2 * a.R, m + h / 2 * a.m, n);
      const Rate c = rate(R_ + h / 2 * b.R, m + h / 2 * b.m, n);
      const Rate d = rate(R_ + h * c.R, m + h * c.m, n);
      r_ += h / 6 * (a.r + 2 * b.r + 2 * c.r + d.r);
      m += h / 6 * (a.m + 2 * b.m + 2 * c.m + d.m);
      R_ += h / 6 * (a.R + 2 * b.R + 2 * c.R + d.R);
      twist_ = std::max(twist_, std::abs((R_.transpose() * m).z() / kGJ));
    }
    return m;
  }
  std::vector<PointLoad> loads_;
  Vec3 base_moment_ = Vec3::Zero();
  Vec3 r_ = Vec3::Zero();
  Mat3 R_ = Mat3::Identity();
  double twist_ = 0.0;
};

TEST(BeamLargeDeflection, bent_out_of_plane_it_agrees_with_a_shooting_solution_and_does_not_twist) {
  // Forces in different planes make the centreline a space curve. With the same stiffness in every direction and no
  // couple at the tip, m·t is constant along the shaft, so the twist is zero although the curve has torsion.
  const std::vector<PointLoad> loads = {{90.0, {3.0, 0, 0}}, {150.0, {0, -2.4, 0.1}}, {kLength, {0.4, 1.8, -0.1}}};
  const ShootingRod exact(loads);
  ASSERT_LT(exact.largest_twist(), 1e-12);
  double previous_error = 0.0;
  double previous_twist = 0.0;
  for (const int elements : {24, 48}) {
    const auto needle = test::beam(elements);
    test::settle(*needle, loads);
    const double error = (needle->point(kLength) - exact.tip()).norm();
    const double travel = (exact.tip() - Vec3(0, 0, kLength)).norm();
    const Vec3 a = needle->tangent(60.0);
    const Vec3 b = needle->tangent(140.0);
    EXPECT_GT(std::abs(a.cross(b).normalized().dot(needle->tangent(kLength))), 0.05) << "a plane curve";
    EXPECT_LT(error, 0.005 * travel);
    EXPECT_LT((needle->tangent(kLength) - exact.tip_tangent()).norm(), 0.005);
    double twist = 0.0;
    for (int e = 0; e < elements; ++e) twist = std::max(twist, std::abs(needle->state()[3 * e + 2]));
    EXPECT_LT(twist, 1e-5);  // [1/mm]; the curvature is 1e-2
    if (elements == 48) {
      EXPECT_NEAR(std::log2(previous_error / error), 2.0, 0.3);
      EXPECT_LT(twist, 0.3 * previous_twist);
    }
    previous_error = error;
    previous_twist = twist;
  }
}

TEST(BeamLargeDeflection, constant_curvature_and_twist_is_exactly_a_helix) {
  const auto needle = test::beam(7);
  const Vec3 kappa(0.012, -0.009, 0.02);
  needle->set_state(kappa.replicate(7, 1));
  const double angle_rate = kappa.norm();
  const Vec3 axis = kappa.normalized();
  const Vec3 z = Vec3::UnitZ();
  for (const double s : {0.0, 3.3, 61.0, 137.2, 200.0}) {
    const double t = angle_rate * s;
    const Vec3 along = axis * axis.dot(z);
    const Vec3 across = z - along;
    const Vec3 expected = along * s + (across * std::sin(t) + axis.cross(z) * (1.0 - std::cos(t))) / angle_rate;
    EXPECT_LT((needle->point(s) - expected).norm(), 1e-12 * kLength) << s;
    EXPECT_LT((needle->tangent(s) - along - across * std::cos(t) - axis.cross(z) * std::sin(t)).norm(), 1e-13) << s;
  }
  EXPECT_NEAR(needle->energy(), 0.5 * kLength * (kEI * (0.012 * 0.012 + 0.009 * 0.009) + kGJ * 0.02 * 0.02), 1e-9);
}

}  // namespace
}  // namespace stylet
