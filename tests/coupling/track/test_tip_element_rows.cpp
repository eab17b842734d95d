// SPDX-License-Identifier: GPL-3.0-or-later
// The compliances of the nodes of the tip's element, kept from element to element and interpolated within one element.
#include "coupling/track/tip_element_rows.hpp"

#include <gtest/gtest.h>

using namespace stylet;

namespace {

constexpr int kPoints = 3;

/// A compliance between a node and a point for these tests: a different number for each pair.
Mat3 of(Index node, int point) { return (100.0 * node + point) * Mat3::Identity() + 0.5 * Mat3::Ones(); }

/// Moves the tip into an element of four nodes and writes the rows of its new nodes.
/// @return the new displacement nodes
std::vector<Index> enter(TipElementRows& rows, Index tet, const std::array<Index, 4>& nodes) {
  Shape shape{.count = 4};
  std::copy(nodes.begin(), nodes.end(), shape.node.begin());
  std::vector<Index> fresh;
  for (const int number : rows.move({tet, Vec4::Constant(0.25)}, shape)) {
    fresh.push_back(rows.element().node(number));
    for (int point = 1; point <= kPoints; ++point) rows.row(number, point) = of(fresh.back(), point);
  }
  return fresh;
}

}  // namespace

TEST(TipElementRows, ask_for_the_rows_of_new_nodes_only) {
  TipElementRows rows(kPoints);
  EXPECT_LT(rows.at().tet, 0);
  EXPECT_EQ(enter(rows, 5, {1, 2, 3, 4}), (std::vector<Index>{1, 2, 3, 4}));
  EXPECT_TRUE(enter(rows, 5, {1, 2, 3, 4}).empty()) << "the same element";
  EXPECT_EQ(enter(rows, 6, {2, 3, 4, 9}), (std::vector<Index>{9})) << "the element beyond a face";
  EXPECT_EQ(rows.at().tet, 6);
  rows.reset();
  EXPECT_LT(rows.at().tet, 0);
  EXPECT_EQ(rows.element().count(), 0);
  EXPECT_EQ(enter(rows, 6, {2, 3, 4, 9}).size(), 4u) << "nothing is left from before";
}

TEST(TipElementRows, what_lies_in_the_element_has_the_weighted_sum_of_the_nodes_rows) {
  TipElementRows rows(kPoints);
  enter(rows, 5, {1, 2, 3, 4});
  enter(rows, 6, {9, 2, 4, 3});
  const Shape place{.count = 4, .node = {9, 2, 4, 3}, .weight = {0.5, 0.25, 0.125, 0.125}};
  const auto weights = rows.element().weights(place);
  ASSERT_TRUE(weights.has_value());
  for (const int points : {0, 2, kPoints}) {
    const auto row = rows.combine(*weights, points);
    ASSERT_EQ(row.cols(), 3 * points);
    for (int point = 1; point <= points; ++point) {
      Mat3 expected = Mat3::Zero();
      for (std::size_t i = 0; i < 4; ++i) expected += place.weight[i] * of(place.node[i], point);
      EXPECT_LE((row.middleCols<3>(3 * static_cast<Eigen::Index>(point - 1)) - expected).norm(),
                1e-13 * expected.norm());
    }
  }
}
