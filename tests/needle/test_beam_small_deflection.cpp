// SPDX-License-Identifier: GPL-3.0-or-later
// Cantilever formulae of Euler–Bernoulli theory, with loads so small that geometry is linear to 1e-6.
#include "stylet/needle/theory.hpp"
#include "support.hpp"

#include <cmath>

namespace stylet {
namespace {

using test::kEI;
using test::kLength;
constexpr double kForce = 1e-5;

double deflection(double F, double a, double s) { return cantilever_deflection(F, a, s, kEI); }

double error_of_tip(int elements, const std::vector<PointLoad>& loads, double expected) {
  const auto needle = test::beam(elements);
  test::settle(*needle, loads, 1e-12);
  return needle->point(kLength).x() / expected - 1.0;
}

TEST(BeamSmallDeflection, end_load_within_half_a_percent_and_second_order) {
  const double expected = kForce * std::pow(kLength, 3) / (3.0 * kEI);
  const std::vector<PointLoad> loads = {{kLength, {kForce, 0, 0}}};
  const double at_12 = error_of_tip(12, loads, expected);
  const double at_24 = error_of_tip(24, loads, expected);
  EXPECT_LT(std::abs(at_24), 0.005);
  EXPECT_NEAR(std::log2(at_12 / at_24), 2.0, 0.05);
}

TEST(BeamSmallDeflection, distributed_load_within_half_a_percent_and_second_order) {
  // Midpoint rule over 50 strips. Summing the exact deflections of its point loads eliminates its own error against q
  // L⁴/(8 EI).
  std::vector<PointLoad> loads;
  double expected = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double s = kLength * (i + 0.5) / 50;
    loads.push_back({s, {kForce / 50, 0, 0}});
    expected += deflection(kForce / 50, s, kLength);
  }
  EXPECT_NEAR(expected, kForce * std::pow(kLength, 3) / (8.0 * kEI), 5e-4 * expected);
  const double at_12 = error_of_tip(12, loads, expected);
  const double at_24 = error_of_tip(24, loads, expected);
  EXPECT_LT(std::abs(at_24), 0.005);
  EXPECT_NEAR(std::log2(at_12 / at_24), 2.0, 0.15);
}

TEST(BeamSmallDeflection, moment_of_a_force_couple_bends_into_a_circle) {
  // Two opposite forces at a distance d at the tip give a constant moment F d over the rest of the shaft.
  constexpr double d = 2.0;
  const auto needle = test::beam();
  const std::vector<PointLoad> loads = {{kLength - d, {-0.001, 0, 0}}, {kLength, {0.001, 0, 0}}};
  test::settle(*needle, loads, 1e-12);
  const double curvature = 0.001 * d / kEI;
  for (const double s : {50.0, 100.0, 180.0}) {
    EXPECT_NEAR(needle->point(s).x(), curvature * s * s / 2.0, 0.005 * curvature * s * s / 2.0) << s;
    EXPECT_NEAR(needle->tangent(s).x(), curvature * s, 0.005 * curvature * s) << s;
  }
}

TEST(BeamSmallDeflection, axial_load_changes_nothing_below_buckling) {
  const auto needle = test::beam();
  test::settle(*needle, std::vector<PointLoad>{{kLength, {0, 0, -0.5}}});
  EXPECT_LT((needle->point(kLength) - Vec3(0, 0, kLength)).norm(), 1e-12);
}

}  // namespace
}  // namespace stylet
