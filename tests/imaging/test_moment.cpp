// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/box_mesh.hpp"
#include "stylet/imaging/moment.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

TEST(Moment, at_rest_has_a_displacement_of_zero_for_each_node) {
  const TetMesh mesh = box_mesh({0, 0, 0}, {10, 10, 10}, {2, 2, 2}, 0.0);
  const Moment moment = moment_at_rest(mesh);
  EXPECT_EQ(moment.displacement.cols(), mesh.node_count());
  EXPECT_TRUE(moment.displacement.isZero(0.0F));
  EXPECT_TRUE(moment.needles.empty());
}

}  // namespace
}  // namespace stylet
