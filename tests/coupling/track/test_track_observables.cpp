// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/track/track_observables.hpp"

#include "coupling/two_region_block.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace stylet;
using stylet::test::Block;

TEST(TrackObservables, mark_the_nodes_of_their_shapes_and_of_the_tip_s) {
  const Block block{2};
  const Shape added = block.tissue->shape(3, Vec4(0.1, 0.2, 0.3, 0.4));
  const Shape tip = block.tissue->shape(7, Vec4(0.25, 0.25, 0.25, 0.25));
  TrackObservables observables{block.store, 8, 4};
  observables.set(TrackObservables::kTip, tip);
  observables.add(added);
  std::vector<unsigned> stamps(static_cast<std::size_t>(block.tissue->displacement_nodes()), 0);
  observables.mark_nodes(stamps, 9);
  for (Index node = 0; node < block.tissue->displacement_nodes(); ++node) {
    const auto has = [&](const Shape& shape) {
      const auto nodes = std::span(shape.node).first(static_cast<std::size_t>(shape.count));
      return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
    };
    EXPECT_EQ(stamps[static_cast<std::size_t>(node)], has(added) || has(tip) ? 9u : 0u) << node;
  }
}
