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

}  // namespace
}  // namespace stylet
