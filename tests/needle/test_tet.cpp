// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/tet.hpp"

#include "needle/block_band.hpp"
#include "needle/tet_shape.hpp"
#include "needle/tet_tangent.hpp"
#include "support.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace stylet {
namespace {

using Segment = TetNeedle::Segment;
using tet::TetShape;
using tet::TetTangent;

using test::kEI;
using test::kLength;

std::unique_ptr<TetNeedle> tets(int segments = 60, Segment segment = Segment::symmetric,
                                const NeedleSection& section = {}) {
  auto built = TetNeedle::build(section, segments, 64, segment);
  EXPECT_TRUE(built.ok()) << (built.ok() ? "" : built.error().message());
  return std::move(built).value();
}

/// Tip compliance [mm/N] of the straight needle.
Mat3 tip_compliance(TetNeedle& needle) {
  return test::compliance_of(needle, std::vector<PointLoad>{{needle.length(), Vec3::Zero()}});
}

TEST(TetSegment, fills_the_bar_without_gap_or_overlap) {
  for (const Segment kind : {Segment::symmetric, Segment::asymmetric}) {
    const auto mesh = tet::make_segment(kind, 1.3, 2.1);
    double volume = 0.0;
    for (const auto& element : mesh.elements) {
      EXPECT_GT(element.volume, 0.0);
      volume += element.volume;
    }
    EXPECT_NEAR(volume, 1.3 * 1.3 * 2.1, 1e-12);
    EXPECT_EQ(mesh.elements.size(), kind == Segment::symmetric ? 24U : 12U);
  }
}

/// A bar that is bent, twisted and stretched.
TetShape deformed(Segment kind, int segments = 4) {
  TetShape shape(tet::make_segment(kind, 1.27, 2.0), segments, 2.0, 9000.0, 0.3);
  for (Eigen::Index i = 0; i < shape.displacement.size(); ++i)
    shape.displacement[i] = 0.05 * std::sin(1.9 * static_cast<double>(i) + 0.3);
  shape.update();
  return shape;
}

TEST(TetDerivatives, force_and_stiffness_match_finite_differences_of_the_energy) {
  const std::vector<PointLoad> loads = {{3.1, {0.3, -0.2, 0.5}}, {8.0, {-0.1, 0.4, 0.2}}, {0.0, {1.0, 1.0, 1.0}}};
  const Mat3 base = Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (const Segment kind : {Segment::symmetric, Segment::asymmetric}) {
    TetShape shape = deformed(kind);
    TetTangent tangent(shape, 4);
    const auto potential = [&] {
      double value = shape.energy();
      for (const PointLoad& load : loads) value -= load.force.dot(base * shape.point(load.s));
      return value;
    };
    const auto gradient = [&] {
      tangent.assemble(shape, base, loads);
      return tangent.gradient();
    };
    const VecX g = gradient();
    const MatX K = tangent.stiffness(shape);
    constexpr double h = 1e-5;
    for (Eigen::Index i = 0; i < g.size(); ++i) {
      const double centre = shape.displacement[i];
      shape.displacement[i] = centre + h;
      shape.update();
      const double above = potential();
      const VecX g_above = gradient();
      shape.displacement[i] = centre - h;
      shape.update();
      const double below = potential();
      const VecX g_below = gradient();
      shape.displacement[i] = centre;
      shape.update();
      EXPECT_NEAR((above - below) / (2.0 * h), g[i], 1e-6 * g.norm()) << i;
      EXPECT_LT(((g_above - g_below) / (2.0 * h) - K.col(i)).norm(), 1e-6 * K.norm()) << i;
    }
  }
}

TEST(TetDerivatives, elimination_and_band_solve_what_a_dense_factor_solves) {
  const std::vector<PointLoad> loads = {{3.1, {0.3, -0.2, 0.5}}, {8.0, {-0.1, 0.4, 0.2}}};
  const Mat3 base = Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const std::vector<Mat3> springs = {Vec3(3.0, 2.0, 0.0).asDiagonal(), Vec3(0.0, 5.0, 1.0).asDiagonal()};
  for (const Segment kind : {Segment::symmetric, Segment::asymmetric}) {
    TetShape shape = deformed(kind);
    shape.displacement *= 0.1;  // makes the tangent positive definite
    shape.update();
    TetTangent tangent(shape, 2);
    for (const bool lent : {false, true}) {
      tangent.assemble(shape, base, loads, lent ? std::span<const Mat3>(springs) : std::span<const Mat3>());
      ASSERT_EQ(tangent.material_shift(), 0.0);
      MatX J = MatX::Zero(6, shape.displacement.size());
      for (int c = 0; c < 2; ++c) {
        const auto w = shape.curve().weights(loads[static_cast<std::size_t>(c)].s);
        for (int i = 0; i < AxisCurve::kReach; ++i) {
          if (w.value[i] != 0.0) J.block<3, 3>(3 * c, shape.axis_dof(w.first + i)) = w.value[i] * base;
        }
      }
      MatX K = tangent.stiffness(shape);
      if (lent) {
        for (int c = 0; c < 2; ++c)
          K += J.middleRows<3>(3 * c).transpose() * springs[static_cast<std::size_t>(c)] * J.middleRows<3>(3 * c);
      }
      const MatX inverse = K.inverse();
      MatX compliance(6, 6);
      VecX free(6);
      tangent.condense(compliance, free);
      const MatX exact = J * inverse * J.transpose();
      EXPECT_LT((compliance - exact).norm(), 1e-9 * exact.norm());
      EXPECT_EQ((compliance - compliance.transpose()).norm(), 0.0);
      EXPECT_LT((free + J * inverse * tangent.gradient()).norm(), 1e-9 * free.norm());
      auto changed = loads;
      changed[0].force += Vec3(0.2, 0.1, -0.3);
      const VecX before = shape.displacement;
      const VecX step =
          inverse * (J.leftCols(J.cols()).topRows<3>().transpose() * Vec3(0.2, 0.1, -0.3) - tangent.gradient());
      tangent.step(changed, shape);
      EXPECT_LT((shape.displacement - before - step).norm(), 1e-9 * step.norm());
      shape.displacement = before;
      shape.update();
    }
  }
}

TEST(TetCalibration, tip_deflects_as_theory_says_for_any_number_of_segments_and_section) {
  for (const int segments : {4, 24, 60, 120}) {
    for (const NeedleSection& section :
         {NeedleSection{},
          NeedleSection{.length_mm = 150.0, .outer_diameter_mm = 0.9, .bending_stiffness_Nmm2 = 4000.0}}) {
      const auto needle = tets(segments, Segment::symmetric, section);
      const double theory = std::pow(section.length_mm, 3) / (3.0 * section.bending_stiffness_Nmm2);
      EXPECT_NEAR(tip_compliance(*needle)(0, 0), theory, 1e-6 * theory);
      EXPECT_NEAR(needle->young_modulus() * needle->stiffening(),
                  12.0 * section.bending_stiffness_Nmm2 / std::pow(section.outer_diameter_mm, 4),
                  1e-9 * needle->young_modulus() * needle->stiffening());
    }
  }
}

TEST(TetCalibration, linear_tetrahedra_bend_far_too_stiffly_the_more_so_the_longer_the_segments) {
  // 1/stiffening, as a function of segment length / width.
  double before = 1.0;
  for (const auto& [segments, least, most] : {std::tuple{157, 0.5, 0.65}, {60, 0.2, 0.25}, {24, 0.03, 0.05}}) {
    const double softness = 1.0 / tets(segments)->stiffening();
    EXPECT_GT(softness, least) << segments;
    EXPECT_LT(softness, most) << segments;
    EXPECT_LT(softness, before) << segments;
    before = softness;
  }
}

TEST(TetCalibration, along_its_axis_the_needle_stays_far_stiffer_than_tissue) {
  EXPECT_GT(tets()->axial_stiffness(), 100.0);  // [N/mm]; tissue around a needle has about 1 N/mm
  EXPECT_NEAR(tip_compliance(*tets())(2, 2) * tets()->axial_stiffness(), 1.0, 1e-6);
}

/// Computes a table of docs/theory/needle.md: run this test with --gtest_filter and read its output.
TEST(TetCalibration, a_wider_section_stretches_more_and_newton_gains_little) {
  double before = 1e300;
  std::printf("width mm | stiffening | E MPa | axial N/mm | Newton steps to 0.1 N at the tip\n");
  for (const double width : {1.0, 1.27, 2.0, 3.0, 4.0}) {
    const auto needle = tets(60, Segment::symmetric, {.outer_diameter_mm = width, .bending_stiffness_Nmm2 = 10000.0});
    const double axial = needle->axial_stiffness();
    const int steps = test::settle(*needle, std::vector<PointLoad>{{kLength, {0.1, 0.0, 0.0}}}, 1e-8);
    std::printf("%8.2f | %10.3f | %5.0f | %10.1f | %d\n", width, needle->stiffening(), needle->young_modulus(), axial,
                steps);
    EXPECT_LT(axial, before);
    before = axial;
  }
}

/// Deflection under a lateral tip force as a function of its direction, relative to the mean deflection: its spread,
/// and the largest deflection perpendicular to the force.
struct Lateral {
  double spread = 0.0;
  double sideways = 0.0;
};
Lateral lateral(TetNeedle& needle) {
  const Mat3 C = tip_compliance(needle);
  const double mean = 0.5 * (C(0, 0) + C(1, 1));
  Lateral found;
  double least = 1e300;
  double most = 0.0;
  for (int k = 0; k < 24; ++k) {
    const double angle = std::numbers::pi * k / 24;
    const Vec3 direction(std::cos(angle), std::sin(angle), 0.0);
    const Vec3 u = C * direction;
    least = std::min(least, u.dot(direction));
    most = std::max(most, u.dot(direction));
    found.sideways = std::max(found.sideways, std::abs(Vec3::UnitZ().cross(direction).dot(u)) / mean);
  }
  found.spread = (most - least) / mean;
  return found;
}

TEST(TetSegment, symmetric_one_bends_alike_in_every_direction_asymmetric_one_does_not_and_goes_sideways) {
  const Lateral good = lateral(*tets(60, Segment::symmetric));
  EXPECT_LT(good.spread, 1e-6);
  EXPECT_LT(good.sideways, 1e-6);
  const Lateral bad = lateral(*tets(60, Segment::asymmetric));
  EXPECT_GT(bad.spread, 0.3);     // deflection depends on the force's direction by 35 %
  EXPECT_GT(bad.sideways, 0.15);  // and is not along the force
}

TEST(TetNeedle, newton_converges_quadratically_from_a_nearby_shape) {
  const auto needle = tets();
  std::vector<PointLoad> loads = {{kLength, {0.3, 0.1, -0.2}}, {120.0, {-0.2, 0.3, 0.0}}};
  test::settle(*needle, loads, 1e-8);
  loads[0].force.x() += 1e-3;
  MatX compliance(6, 6);
  VecX free(6);
  std::vector<double> residuals;
  for (int i = 0; i < 5 && (residuals.empty() || residuals.back() > 1e-8); ++i) {
    EXPECT_TRUE(needle->linearise(loads, compliance, free));
    needle->advance(loads);
    residuals.push_back(needle->residual(loads));
  }
  EXPECT_LE(residuals.back(), 1e-8);
  EXPECT_LE(residuals.size(), 4U);
}

TEST(TetNeedle, rounding_leaves_less_than_the_coupled_solver_asks_for) {
  // The limit is a tenth of the solver's tolerance (1e-9 … 1e-8) × largest force or 1 N × length, for short and long
  // needles, nearly straight and strongly bent.
  for (const double length : {20.0, 100.0, 200.0, 400.0}) {
    for (const double deflection : {0.01, 0.4}) {
      const auto needle = tets(60, Segment::symmetric, {.length_mm = length});
      const double force = 3.0 * kEI * deflection / (length * length);
      MatX compliance(3, 3);
      VecX free(3);
      std::vector<PointLoad> loads = {{0.9 * length, Vec3::Zero()}};
      for (int i = 1; i <= 40; ++i) {
        loads[0].force.x() = force * std::min(1.0, i / 20.0);
        needle->linearise(loads, compliance, free);
        needle->advance(loads);
      }
      EXPECT_LT(needle->residual(loads), 0.3e-10 * std::max(1.0, force) * length) << length << " mm, " << force << " N";
    }
  }
}

}  // namespace
}  // namespace stylet
