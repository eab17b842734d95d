// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of the tetrahedra's tangent, in cases that the tests of the whole tangent leave out.
#include "needle/bar_stiffness.hpp"
#include "needle/middle_nodes.hpp"
#include "support.hpp"

#include <cmath>

namespace stylet {
namespace {

using Segment = TetNeedle::Segment;
using tet::BarStiffness;
using tet::kBlock;
using tet::kFirstMiddle;
using tet::MiddleNodes;
using tet::SegmentStiffness;
using tet::TetShape;

constexpr int kSegments = 3;

/// A bar that is bent, twisted and stretched.
TetShape deformed_bar(Segment kind) {
  TetShape shape(tet::make_segment(kind, 1.27, 2.0), kSegments, 2.0, 9000.0, 0.3);
  for (Eigen::Index i = 0; i < shape.displacement.size(); ++i)
    shape.displacement[i] = 0.005 * std::sin(1.9 * static_cast<double>(i) + 0.3);
  shape.update();
  return shape;
}

TEST(MiddleNodes, say_where_the_stiffness_is_not_definite) {
  const TetShape shape = deformed_bar(Segment::symmetric);
  BarStiffness stiffness(shape);
  stiffness.assemble(shape);
  SegmentStiffness K = stiffness.segment(0);
  K.geometric(kFirstMiddle, kFirstMiddle) = -1e6;
  MiddleNodes middle(shape.mesh(), kSegments);
  EXPECT_FALSE(middle.eliminate(0, K, 0.0));
}

TEST(MiddleNodes, disconnected_ones_move_by_their_own_force_only) {
  const TetShape shape = deformed_bar(Segment::symmetric);
  MiddleNodes middle(shape.mesh(), kSegments);
  middle.disconnect();
  const VecX gradient = VecX::LinSpaced(shape.displacement.size(), -1.0, 2.0);
  VecX layers(kBlock * kSegments);
  middle.reduce(gradient, layers);
  VecX displacement = VecX::Zero(gradient.size());
  middle.move(VecX::Zero(layers.size()), displacement);
  const int inner = 3 * shape.mesh().middle_nodes();
  for (int k = 0; k < kSegments; ++k) {
    const Eigen::Index at = k * (inner + kBlock);
    EXPECT_EQ(layers.segment<kBlock>(kBlock * k), gradient.segment<kBlock>(at + inner));
    EXPECT_EQ(displacement.segment(at, inner), -gradient.segment(at, inner));
    EXPECT_TRUE(displacement.segment<kBlock>(at + inner).isZero(0.0));
  }
}

}  // namespace
}  // namespace stylet
