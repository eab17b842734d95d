// SPDX-License-Identifier: GPL-3.0-or-later
// Every model against beam theory: small deflections to Euler–Bernoulli, large ones to the elastica.
#include "needle_model_test.hpp"
#include "stylet/needle/tet.hpp"
#include "stylet/needle/theory.hpp"
#include "support.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

namespace stylet {
namespace {

constexpr double kLength = 200.0;
constexpr double kEI = 15722.0;
constexpr double kForce = 1e-5;  // [N] geometry stays linear to 1e-6
constexpr double kDegree = std::numbers::pi / 180.0;

class NeedleTheory : public test::NeedleModelTest {
 protected:
  /// Allowed error of small deflections over theory.
  [[nodiscard]] static double small() { return model() == "tet" ? 0.02 : 0.005; }
};

double deflection(double F, double a, double s) { return cantilever_deflection(F, a, s, kEI); }

TEST_P(NeedleTheory, SmallDeflectionsAreEulerBernoullisWhereverTheLoad) {
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

TEST_P(NeedleTheory, ACoupleBendsItIntoACircle) {
  // Two opposite forces at the tip: constant moment over the rest of the shaft.
  constexpr double d = 40.0;
  const auto needle = make();
  test::settle(*needle, std::vector<PointLoad>{{kLength - d, {-0.001, 0, 0}}, {kLength, {0.001, 0, 0}}}, 1e-10);
  const double curvature = 0.001 * d / kEI;
  for (const double s : {50.0, 100.0, 150.0}) {
    // Rods see their joints' moments: the shape is the circle's up to the rounding of its corners at the clamp.
    EXPECT_NEAR(needle->point(s).x(), curvature * s * s / 2.0, 2.0 * small() * curvature * s * s / 2.0) << s;
    EXPECT_NEAR(needle->tangent(s).x(), curvature * s, 2.0 * small() * curvature * s) << s;
  }
}

TEST_P(NeedleTheory, LateralStiffnessIsTheSameInEveryDirectionAndNothingGoesSideways) {
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

TEST_P(NeedleTheory, FollowsTheElasticaToSixtyDegreesWithinOnePercent) {
  const auto needle = make();
  for (const double degrees : {5.0, 20.0, 40.0, 60.0}) {
    const Elastica exact(degrees * kDegree, kLength, kEI);
    test::settle(*needle, std::vector<PointLoad>{{kLength, {exact.force, 0, 0}}}, 1e-7);
    const Vec3 tip = needle->point(kLength);
    EXPECT_NEAR(tip.x(), exact.deflection, 0.01 * exact.deflection) << degrees;
    EXPECT_NEAR(kLength - tip.z(), kLength - exact.reach, 0.01 * (kLength - exact.reach)) << degrees;
    EXPECT_NEAR(std::asin(needle->tangent(kLength).x()), degrees * kDegree, 0.01 * degrees * kDegree) << degrees;
  }
}

TEST_P(NeedleTheory, BucklesAtEulersLoad) {
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

/// Time [µs] of one linearise + advance with 20 loads over the outer half, the least of several tries.
double iteration_us(Needle& needle) {
  std::vector<PointLoad> loads;
  for (int c = 1; c <= 20; ++c) loads.push_back({100.0 + 5.0 * c, Vec3(5e-4, 1e-3, -5e-4)});
  MatX compliance(60, 60);
  VecX free(60);
  double least = 1e300;
  for (int i = 0; i < 10; ++i) {
    const auto start = std::chrono::steady_clock::now();
    needle.linearise(loads, compliance, free);
    needle.advance(loads);
    const std::chrono::duration<double, std::micro> taken = std::chrono::steady_clock::now() - start;
    least = std::min(least, taken.count());
  }
  return least;
}

/// The table of docs/theory/needle.md: run this test with --gtest_filter and read its output.
TEST(NeedleModels, AccuracyAgainstCost) {
  const Elastica exact(60.0 * kDegree, kLength, kEI);
  std::printf("model   | elements | load at L/3 | load at L | elastica 60 deg | axial N/mm | stiffening | µs\n");
  for (const auto& [model, counts] :
       {std::pair{"beam", std::vector{12, 24, 48}}, {"springs", {12, 24, 48}}, {"tet", {24, 40, 60, 80, 120}}}) {
    for (const int count : counts) {
      auto built = make_needle(model, {}, count, 20);
      ASSERT_TRUE(built.ok());
      Needle& needle = **built;
      const double third = kLength / 3.0;
      const MatX small =
          test::compliance_of(needle, std::vector<PointLoad>{{third, Vec3::Zero()}, {kLength, Vec3::Zero()}});
      const double inner = small(3, 0) / deflection(1.0, third, kLength) - 1.0;
      const double end = small(3, 3) / deflection(1.0, kLength, kLength) - 1.0;
      const auto* tet = dynamic_cast<const TetNeedle*>(&needle);
      test::settle(needle, std::vector<PointLoad>{{kLength, {exact.force, 0, 0}}}, 1e-7);
      const double large = needle.point(kLength).x() / exact.deflection - 1.0;
      needle.straighten();
      std::printf("%-7s | %8d | %10.3f%% | %8.3f%% | %14.3f%% | %10.4g | %10.4g | %.0f\n", model, count, 100 * inner,
                  100 * end, 100 * large,
                  tet != nullptr ? tet->axial_stiffness() : std::numeric_limits<double>::infinity(),
                  tet != nullptr ? tet->stiffening() : 1.0, iteration_us(needle));
      if (count == default_needle_elements(model).value()) {
        EXPECT_LT(std::abs(inner), 0.01);
        EXPECT_LT(std::abs(end), 0.002);
        EXPECT_LT(std::abs(large), 0.005);
      }
    }
  }
}

}  // namespace
}  // namespace stylet
