// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the parts of the tetrahedra's tangent one by one.
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

TEST(BarStiffness, is_the_derivative_of_the_nodal_forces) {
  for (const Segment kind : {Segment::symmetric, Segment::asymmetric}) {
    TetShape shape = deformed_bar(kind);
    BarStiffness stiffness(shape);
    stiffness.assemble(shape);
    const MatX K = stiffness.whole(shape);
    constexpr double h = 1e-6;
    for (Eigen::Index i = 0; i < K.cols(); ++i) {
      const double centre = shape.displacement[i];
      shape.displacement[i] = centre + h;
      shape.update();
      const VecX above = shape.force();
      shape.displacement[i] = centre - h;
      shape.update();
      const VecX below = shape.force();
      shape.displacement[i] = centre;
      EXPECT_LT(((above - below) / (2.0 * h) - K.col(i)).norm(), 1e-7 * K.norm()) << i;
    }
  }
}

TEST(BarStiffness, follows_the_shape) {
  TetShape shape = deformed_bar(Segment::symmetric);
  BarStiffness kept(shape);
  kept.assemble(shape);
  shape.displacement *= 0.5;
  shape.update();
  kept.assemble(shape);
  BarStiffness fresh(shape);
  fresh.assemble(shape);
  EXPECT_EQ(kept.whole(shape), fresh.whole(shape));
}

/// The whole matrix of a segment with the shift added, nodes in order.
MatX whole(const SegmentStiffness& K, int nodes, double shift) {
  MatX full = MatX::Zero(3 * nodes, 3 * nodes);
  for (int i = 0; i < nodes; ++i) {
    for (int j = 0; j <= i; ++j) {
      const Mat3 block = (1.0 + shift) * K.material.block<3, 3>(3 * i, 3 * j) + K.geometric(i, j) * Mat3::Identity();
      full.block<3, 3>(3 * i, 3 * j) = block;
      full.block<3, 3>(3 * j, 3 * i) = block.transpose();
    }
  }
  return full;
}

TEST(MiddleNodes, leave_the_layers_the_schur_complement) {
  const TetShape shape = deformed_bar(Segment::symmetric);
  BarStiffness stiffness(shape);
  stiffness.assemble(shape);
  MiddleNodes middle(shape.mesh(), kSegments);
  const auto nodes = static_cast<int>(shape.mesh().nodes.size());
  constexpr Eigen::Index layers = 3 * kFirstMiddle;
  for (const double shift : {0.0, 0.4}) {
    ASSERT_TRUE(middle.eliminate(1, stiffness.segment(1), shift));
    const MatX K = whole(stiffness.segment(1), nodes, shift);
    const Eigen::Index inner = K.rows() - layers;
    const MatX left = K.topLeftCorner(layers, layers) - K.topRightCorner(layers, inner) *
                                                            K.bottomRightCorner(inner, inner).inverse() *
                                                            K.bottomLeftCorner(inner, layers);
    for (const auto& [row, column] : {std::pair{0, 0}, {1, 0}, {1, 1}}) {
      MatX difference = middle.left(row, column) - left.block<kBlock, kBlock>(kBlock * row, kBlock * column);
      if (row == column) difference = MatX(difference.triangularView<Eigen::Lower>());
      EXPECT_LT(difference.norm(), 1e-11 * left.norm()) << row << ' ' << column;
    }
  }
}

/// Solves the whole bar: middle nodes by elimination, layers by a dense factor.
VecX solve(MiddleNodes& middle, const BarStiffness& stiffness, const VecX& force) {
  MatX left = MatX::Zero(kBlock * kSegments, kBlock * kSegments);
  for (int k = 0; k < kSegments; ++k) {
    EXPECT_TRUE(middle.eliminate(k, stiffness.segment(k), 0.0));
    left.block<kBlock, kBlock>(kBlock * k, kBlock * k) += middle.left(1, 1);
    if (k == 0) continue;
    left.block<kBlock, kBlock>(kBlock * k, kBlock * (k - 1)) += middle.left(1, 0);
    left.block<kBlock, kBlock>(kBlock * (k - 1), kBlock * (k - 1)) += middle.left(0, 0);
  }
  const MatX full = left.selfadjointView<Eigen::Lower>();
  VecX layers(kBlock * kSegments);
  middle.reduce(force, layers);
  const VecX motion = -full.inverse() * layers;
  VecX displacement = VecX::Zero(force.size());
  middle.move(motion, displacement);
  return displacement;
}

TEST(MiddleNodes, reduce_and_move_solve_the_whole_bar) {
  // The asymmetric segment has no middle nodes.
  for (const Segment kind : {Segment::symmetric, Segment::asymmetric}) {
    const TetShape shape = deformed_bar(kind);
    BarStiffness stiffness(shape);
    stiffness.assemble(shape);
    MiddleNodes middle(shape.mesh(), kSegments);
    const VecX gradient = VecX::LinSpaced(shape.displacement.size(), -1.0, 2.0);
    const VecX moved = solve(middle, stiffness, gradient);
    EXPECT_LT((stiffness.whole(shape) * moved + gradient).norm(), 1e-8 * gradient.norm());
  }
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
