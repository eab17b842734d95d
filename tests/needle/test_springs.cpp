// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/springs.hpp"

#include "needle/beam_shape.hpp"
#include "needle/beam_tangent.hpp"
#include "support.hpp"

#include <cmath>

namespace stylet {
namespace {

using beam::BeamShape;
using beam::BeamTangent;
using beam::ElementKind;

using test::kEI;
using test::kLength;

/// Lateral tip compliance of a straight needle / theory, L³/3EI.
double softness(double clamp_weight, int rods) {
  BeamShape shape(rods, kLength, kEI, 12100.0, ElementKind::rod);
  shape.set_clamp_weight(clamp_weight);
  BeamTangent tangent(shape, 1);
  MatX compliance(3, 3);
  VecX free(3);
  tangent.assemble(shape, Mat3::Identity(), std::vector<PointLoad>{{kLength, Vec3::Zero()}});
  tangent.condense(compliance, free);
  return compliance(0, 0) / (std::pow(kLength, 3) / (3.0 * kEI));
}

TEST(SpringsNeedle, the_clamps_joint_is_twice_as_stiff_or_twenty_rods_are_seven_percent_too_soft) {
  // The sum over the joints of (L - x)²/k, computed by hand: 2870 and 2670 over 8000/3.
  EXPECT_NEAR(softness(1.0, 20), 2870.0 / (8000.0 / 3.0), 1e-9);  // 7.6 %
  EXPECT_NEAR(softness(2.0, 20), 2670.0 / (8000.0 / 3.0), 1e-9);  // 0.125 %
}

TEST(SpringsNeedle, error_falls_with_the_square_of_the_rod_length) {
  EXPECT_NEAR((softness(2.0, 12) - 1.0) / (softness(2.0, 24) - 1.0), 4.0, 0.05);
}

/// Loads on and between joints, at the tip, and at and before the clamp.
std::vector<PointLoad> assorted_loads() {
  return {{97.3, {0.21, -0.4, 0.13}}, {kLength, {-0.3, 0.25, -0.5}}, {3.1, {1.1, -0.6, 0.4}}, {100.0, {0.2, 0.3, -0.9}},
          {196.7, {-0.5, 0.1, 0.3}},  {0.0, {2.0, 1.0, -3.0}},       {-5.0, {1.0, 1.0, 1.0}}};
}

double potential(const BeamShape& shape, const Mat3& base, const std::vector<PointLoad>& loads) {
  double value = shape.energy();
  for (const PointLoad& load : loads) value -= load.force.dot(base * shape.point(load.s));
  return value;
}

TEST(SpringsDerivatives, gradient_and_hessian_match_finite_differences_of_the_potential) {
  const Mat3 base = Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const auto loads = assorted_loads();
  BeamShape shape(8, kLength, kEI, 12100.0, ElementKind::rod);
  for (Eigen::Index i = 0; i < shape.curvature.size(); ++i)
    shape.curvature[i] = 0.02 * std::sin(1.7 * static_cast<double>(i) + 0.4);
  shape.update();
  BeamTangent tangent(shape, 8);
  tangent.assemble(shape, base, loads);
  const VecX g = tangent.gradient();
  const MatX H = tangent.hessian();
  constexpr double h = 1e-5;
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const double centre = shape.curvature[i];
    shape.curvature[i] = centre + h;
    shape.update();
    const double above = potential(shape, base, loads);
    tangent.assemble(shape, base, loads);
    const VecX g_above = tangent.gradient();
    shape.curvature[i] = centre - h;
    shape.update();
    const double below = potential(shape, base, loads);
    tangent.assemble(shape, base, loads);
    const VecX g_below = tangent.gradient();
    shape.curvature[i] = centre;
    shape.update();
    EXPECT_NEAR((above - below) / (2.0 * h), g[i], 1e-6 * g.norm()) << i;
    EXPECT_LT(((g_above - g_below) / (2.0 * h) - H.col(i)).norm(), 1e-6 * H.norm()) << i;
  }
}

}  // namespace
}  // namespace stylet
