// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/track/split_borders.hpp"

#include <algorithm>

namespace stylet {

SplitBorders::SplitBorders(int capacity) {
  splits_.reserve(static_cast<std::size_t>(capacity));
  borders_.reserve(static_cast<std::size_t>(capacity * kMostVertices));
  load_nodes_.reserve(static_cast<std::size_t>(capacity * kMostLoads));
  loads_.reserve(static_cast<std::size_t>(capacity * kMostLoads));
}

void SplitBorders::reset() {
  splits_.clear();
  borders_.clear();
  load_nodes_.clear();
  loads_.clear();
}

void SplitBorders::begin() { splits_.push_back({.border = {borders_.size()}, .loads = {loads_.size()}}); }

void SplitBorders::add(int vertex, const Mat3& k) {
  Range& range = splits_.back().border;
  const auto border = range.of(borders_);
  const auto found =
      std::find_if(border.begin(), border.end(), [&](const Border& there) { return there.vertex == vertex; });
  if (found != border.end()) {
    found->k += k;
    return;
  }
  borders_.push_back({vertex, k});
  ++range.count;
}

void SplitBorders::add_loads(const Shape& vertex, const Mat3& k) {
  Range& range = splits_.back().loads;
  for (std::size_t i = 0; i < static_cast<std::size_t>(vertex.count); ++i) {
    if (vertex.weight[i] == 0.0) continue;
    const Mat3 load = vertex.weight[i] * k;
    const auto nodes = range.of(load_nodes_);
    const auto found = std::find(nodes.begin(), nodes.end(), vertex.node[i]);
    if (found != nodes.end()) {
      range.of(loads_)[static_cast<std::size_t>(found - nodes.begin())] += load;
      continue;
    }
    load_nodes_.push_back(vertex.node[i]);
    loads_.push_back(load);
    ++range.count;
  }
}

}  // namespace stylet
