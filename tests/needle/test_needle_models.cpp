// SPDX-License-Identifier: GPL-3.0-or-later
// Compares every model with beam theory: small deflections with Euler–Bernoulli, large ones with the elastica.
#include "needle_model_test.hpp"
#include "stylet/needle/theory.hpp"
#include "support.hpp"

#include <cmath>
#include <numbers>

namespace stylet {
namespace {

using test::kEI;
using test::kLength;
constexpr double kForce = 1e-5;  // [N] small enough for linear geometry to 1e-6
constexpr double kDegree = std::numbers::pi / 180.0;

class NeedleTheory : public test::NeedleModelTest {
 protected:
  /// Allowed relative error of small deflections.
  [[nodiscard]] static double small() { return model() == "tet" ? 0.02 : 0.005; }
};

double deflection(double F, double a, double s) { return cantilever_deflection(F, a, s, kEI); }

TEST_P(NeedleTheory, small_deflections_are_euler_bernoullis_wherever_the_load) {
  const auto needle = make();
  for (const double a : {40.0, 73.0, 100.0, 131.7, kLength}) {
    needle->straighten();
    test::settle(*needle, std::vector<PointLoad>{{a, {0, kForce, 0}}}, 1e-10);
    const double tip = deflection(kForce, a, kLength);
    for (const double s : {a / 2, a, kLength}) {
      EXPECT_NEAR(needle->point(s).y(), deflection(kForce, a, s), small() * tip)
          << "load at " << a << ", point at " << s;
    }
  }
}

TEST_P(NeedleTheory, a_couple_bends_it_into_a_circle) {
  // Two opposite forces at the tip give a constant moment over the rest of the shaft.
  constexpr double d = 40.0;
  const auto needle = make();
  test::settle(*needle, std::vector<PointLoad>{{kLength - d, {-0.001, 0, 0}}, {kLength, {0.001, 0, 0}}}, 1e-10);
  const double curvature = 0.001 * d / kEI;
  for (const double s : {50.0, 100.0, 150.0}) {
    // Rods have the moments of their joints: the shape is a circle except for the rounding of its corners at the clamp.
    EXPECT_NEAR(needle->point(s).x(), curvature * s * s / 2.0, 2.0 * small() * curvature * s * s / 2.0) << s;
    EXPECT_NEAR(needle->tangent(s).x(), curvature * s, 2.0 * small() * curvature * s) << s;
  }
}

TEST_P(NeedleTheory, lateral_stiffness_is_the_same_in_every_direction_and_nothing_goes_sideways) {
  const auto needle = make();
  double first = 0.0;
  for (int k = 0; k < 12; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 12 + 0.1;
    const Vec3 direction(std::cos(angle), std::sin(angle), 0.0);
    needle->straighten();
    settle(*needle, std::vector<PointLoad>{{kLength, 0.3 * direction}, {88.0, 0.1 * direction}});
    const Vec3 tip = needle->point(kLength);
    if (k == 0) first = tip.dot(direction);
    const double allowed = model() == "tet" ? 0.005 : 1e-10;
    EXPECT_GT(first, 0.2 * kLength);
    EXPECT_NEAR(tip.dot(direction), first, allowed * first);
    EXPECT_NEAR(tip.dot(Vec3::UnitZ().cross(direction)), 0.0, allowed * first);
  }
}

TEST_P(NeedleTheory, follows_the_elastica_to_sixty_degrees_within_one_percent) {
  const auto needle = make();
  for (const double degrees : {5.0, 20.0, 40.0, 60.0}) {
    const Elastica exact(degrees * kDegree, kLength, kEI);
    needle->straighten();
    const int iterations = test::settle(*needle, std::vector<PointLoad>{{kLength, {exact.force, 0, 0}}}, 1e-7);
    if (model() == "beam") {
      EXPECT_LE(iterations, 12) << degrees;
    }
    const Vec3 tip = needle->point(kLength);
    EXPECT_NEAR(tip.x(), exact.deflection, 0.01 * exact.deflection) << degrees;
    EXPECT_NEAR(kLength - tip.z(), kLength - exact.reach, 0.01 * (kLength - exact.reach)) << degrees;
    EXPECT_NEAR(std::asin(needle->tangent(kLength).x()), degrees * kDegree, 0.01 * degrees * kDegree) << degrees;
  }
}

TEST_P(NeedleTheory, buckles_at_eulers_load) {
  const double euler = std::numbers::pi * std::numbers::pi * kEI / (4.0 * kLength * kLength);
  const auto needle = make();
  MatX compliance(3, 3);
  VecX free(3);
  for (const double share : {0.95, 0.98, 1.02, 1.05}) {
    needle->straighten();
    const std::vector<PointLoad> loads = {{kLength, {0, 0, -share * euler}}};
    settle(*needle, loads);
    EXPECT_EQ(needle->linearise(loads, compliance, free), share < 1.0) << share;
    EXPECT_GE(compliance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-12);
  }
}

STYLET_FOR_EVERY_NEEDLE_MODEL(NeedleTheory);

}  // namespace
}  // namespace stylet
